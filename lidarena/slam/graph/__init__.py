"""SLAM by a graph of poses: scan matching, loop closing and sparse optimisation."""
