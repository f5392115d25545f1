"""Potential fields and A* as policies of the arena family."""

from lidarena.baselines.arena import (  # they register themselves
    apf,
    apf_global,
    apf_improved,
    apf_improved_lidar,
    apf_lidar,
    astar,
    velocity_obstacles,
)

__all__ = ["apf", "apf_global", "apf_improved", "apf_improved_lidar", "apf_lidar", "astar", "velocity_obstacles"]
