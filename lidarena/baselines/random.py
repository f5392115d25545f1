"""Random driving: the floor under every comparison."""

import copy
from typing import Any

import gymnasium as gym

from lidarena.baselines.registry import register


@register("random")
class RandomPolicy:
    """Draws every action uniformly from the environment's action space, from a generator of its own."""

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
        """Return a random action, whatever is observed."""
        return self._space.sample()
