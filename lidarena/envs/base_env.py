"""What every family's single environment has in common: a batch of one world."""

from abc import abstractmethod
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from lidarena.envs.infos import Info


class SingleWorld(gym.Env[Any, Any]):
    """One world, whose episodes end when they end: nothing begins before ``reset``.

    Args:
        observation_space: Of the world.
        action_space: Of the world.
        render_mode: One of the class's, or None.
    """

    def __init__(
        self, observation_space: gym.Space[Any], action_space: gym.Space[Any], render_mode: str | None
    ) -> None:
        self.observation_space, self.action_space, self.render_mode = observation_space, action_space, render_mode
        self._running = self._begun = False

    @abstractmethod
    def _begin(self, seed: int | None) -> None:
        """Begin an episode with ``np_random``; ``seed`` is what ``reset`` was given."""

    @abstractmethod
    def _advance(self, action: Any) -> tuple[float, bool, bool]:
        """Act for one decision period; reward, terminated and truncated."""

    @abstractmethod
    def _observe(self) -> Any:
        """A fresh observation."""

    @abstractmethod
    def _info(self) -> Info:
        """A fresh info that shares no memory with the world, since Gymnasium asks that no two steps do."""

    @abstractmethod
    def _picture(self) -> NDArray[np.uint8] | None:
        """A picture; None where a window shows it."""

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        """Begin an episode."""
        super().reset(seed=seed)
        self._begin(seed)
        self._running = self._begun = True
        return self._observe(), self._info()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, Info]:
        """Act for one decision period.

        Raises:
            ActionError: An action that is NaN, out of range, or of the wrong shape or type.
            ResetNeeded: The environment was not reset, or its episode has ended.
        """
        if not self._running:
            raise ResetNeeded(
                "step() needs a running episode; call reset() first, and again after an episode has ended"
            )
        reward, terminated, truncated = self._advance(action)
        self._running = not (terminated or truncated)
        return self._observe(), reward, terminated, truncated, self._info()

    def render(self) -> NDArray[np.uint8] | None:
        """Picture (height, width, 3); None without ``render_mode``, or where a window shows it.

        Raises:
            ResetNeeded: The environment was not reset.
        """
        if self.render_mode is None:
            gym.logger.warn("render() needs render_mode='rgb_array' when the environment is made")
            return None
        if not self._begun:
            raise ResetNeeded("render() needs an episode; call reset() first")
        return self._picture()
