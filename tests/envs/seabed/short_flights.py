"""Short flights over one seabed, so that its frames are computed once for all tests of a process."""

from typing import Any

import gymnasium as gym

import lidarena  # noqa: F401

SHORT: dict[str, Any] = {
    "duration": 4.0,
    "seabeds": 1,
    "count": 120,
    "max_episode_steps": 40,
    "least_matches": 20,
    "skips": [5, 10, 20, 40],
}


def made(**more: Any) -> gym.Env[Any, Any]:
    return gym.make("lidarena/Seabed-v0", **SHORT | more)
