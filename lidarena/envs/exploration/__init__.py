"""Active SLAM: the exploration family."""
