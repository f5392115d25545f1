"""Random driving: the floor under every comparison."""

import copy
from typing import Any

import gymnasium as gym
import numpy as np

from lidarena.baselines.registry import register


@register("random")
class RandomPolicy:
    """Draws every action uniformly from the environment's action space, or from what its mask allows."""

    def __init__(self, env: Any) -> None:
        """Make it for an environment.

        Args:
            env: A Gymnasium environment, or a vector environment of which one world is driven.
        """
        space: gym.Space[Any] = getattr(env, "single_action_space", env.action_space)
        self._space = copy.deepcopy(space)  # the environment's own generator stays untouched
        self.finished = False

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; equal seeds draw equal actions."""
        self._space.seed(seed)

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return a random action; of those that ``info["action_mask"]`` allows, where there is one."""
        mask = info.get("action_mask")
        if mask is not None and isinstance(self._space, gym.spaces.Discrete) and np.shape(mask) == (self._space.n,):
            return self._space.sample(np.asarray(mask, np.int8)) if np.any(mask) else self._space.sample()
        return self._space.sample()
