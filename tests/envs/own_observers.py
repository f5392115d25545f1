"""Observations as a stranger would make them, in a module of its own."""

from typing import Any

import gymnasium as gym
import numpy as np


class Nearest:
    """The nearest hit, what was driven, and whether something was touched: what every family tells."""

    space = gym.spaces.Box(0.0, 1e3, (3,), np.float32)

    def observe(self, info: dict[str, Any]) -> np.ndarray:
        return np.array([info["scan"].min(), info["path_length"], info["collision"]], np.float32)


class InParts:
    """A dictionary."""

    space = gym.spaces.Dict({"pose": gym.spaces.Box(-1e3, 1e3, (3,), np.float64), "touched": gym.spaces.Discrete(2)})

    def observe(self, info: dict[str, Any]) -> dict[str, Any]:
        return {"pose": info["pose"], "touched": np.int64(info["collision"])}


class Curious(Nearest):
    """Looks for the truth."""

    def observe(self, info: dict[str, Any]) -> np.ndarray:
        assert "truth" not in info
        return super().observe(info)


class Wrong(Nearest):
    """Gives another shape than it says."""

    def observe(self, info: dict[str, Any]) -> np.ndarray:
        return super().observe(info)[:2]


class Shapeless(Nearest):
    """A space that no batch can be made of."""

    space = gym.spaces.Text(5)


def made() -> Nearest:
    """Makes one."""
    return Nearest()


def looked(info: dict[str, Any]) -> float:
    """Looks, but has no space."""
    return float(info["time"])


READY = Nearest()
