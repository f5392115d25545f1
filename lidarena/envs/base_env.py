"""What every family's single environment has in common: a batch of one world."""

from collections.abc import Callable
from typing import Any, TypeVar

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.envs.episodes import Episodes
from lidarena.envs.infos import Info, of_world, row_of
from lidarena.envs.seeds import checked_seed
from lidarena.envs.window import may_draw


class SingleWorld(gym.Env[Any, Any]):
    """One world, whose episodes end when they end: nothing begins before ``reset``.

    Args:
        episodes: A batch of one world.

    Attributes:
        family: Name of the family, under which it is registered.
        episodes: That batch.
    """

    family: str

    def __init__(self, episodes: Episodes) -> None:
        self.episodes: Any = episodes
        self.observation_space = episodes.single_observation_space
        self.action_space = episodes.single_action_space
        self.render_mode = episodes.options.render_mode
        self._running = self._begun = False

    @property
    def options(self) -> Any:
        """The checked keywords."""
        return self.episodes.options

    def reset(
        self, *, seed: int | np.integer[Any] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, Info]:
        """Begin an episode.

        Raises:
            ConfigError: A seed that is no whole number of at least 0, or options, of which there are none.
        """
        if options:
            raise ConfigError(f"options = {options!r} were given to reset(), which has none")
        number = checked_seed(seed)
        super().reset(seed=number)
        self.episodes.reset([0], [self.np_random], [number])
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
        rewards, terminated, truncated = self.episodes.step([action])
        ended, cut_off = bool(terminated[0]), bool(truncated[0])
        self._running = not (ended or cut_off)
        return self._observe(), float(rewards[0]), ended, cut_off, self._info()

    def _observe(self) -> Any:
        return row_of(self.episodes.observe(), 0)

    def _info(self) -> Info:
        """A fresh info that shares no memory with the world, since Gymnasium asks that no two steps do."""
        return of_world(self.episodes.infos(), 0, copy=True)

    def render(self) -> NDArray[np.uint8] | None:
        """Picture (height, width, 3); None without ``render_mode``, or where a window shows it.

        Raises:
            ResetNeeded: The environment was not reset.
        """
        return self.episodes.picture(0) if may_draw(self.render_mode, self._begun) else None

    def close(self) -> None:
        """Close the window, if there is one."""
        self.episodes.close()


World = TypeVar("World", bound=SingleWorld)


def entry_point(kind: type[World]) -> Callable[..., World]:
    """Return what ``gym.make`` calls for a class of environments.

    Gymnasium's own ``TimeLimit`` truncates there, and its ``max_episode_steps`` never gets here. From the metadata it
    learns which render modes need a wrapper of its own, such as ``"rgb_array_list"``.
    """

    def make_single(**keywords: Any) -> World:
        return kind(**{"max_episode_steps": -1, **keywords})

    make_single.metadata = kind.metadata  # type: ignore[attr-defined]
    return make_single
