"""Goal reaching among obstacles: the arena family."""
