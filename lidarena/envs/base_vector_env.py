"""What every family's batch has in common: worlds that step together, and what happens where an episode ends."""

import warnings
from collections.abc import Sequence
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, suggest
from lidarena.base.generator_state import generator_from_words, generator_words
from lidarena.envs.episodes import Episodes, Outcome
from lidarena.envs.infos import Info, masked, overwrite, row_of
from lidarena.envs.seeds import Seeds, seeds_of

_COUNTS_RIGHT = (1, 4)
"""Gymnasium's version from which its vector statistics count episodes right that begin in the step of an end."""

Mode = AutoresetMode | str
"""What happens where an episode has ended: Gymnasium's mode or its name."""
SAME_STEP = AutoresetMode.SAME_STEP


class BatchedWorlds(VectorEnv[Any, Any, Any]):
    """Environments that step together; by default one that ends begins its next episode in the same step.

    ``autoreset_mode`` says what happens where an episode has ended:

    - ``AutoresetMode.SAME_STEP``: its next one begins in the same step; ``infos["final_obs"]`` and
      ``infos["final_info"]`` hold the last observation and info of the old one.
    - ``AutoresetMode.NEXT_STEP``: it begins in the next step, whose action is not looked at and whose reward is 0.
    - ``AutoresetMode.DISABLED``: when ``reset(options={"reset_mask": mask})`` is called.

    Args:
        episodes: The worlds.
        autoreset_mode: One of Gymnasium's, or its value such as ``"NextStep"``.

    Attributes:
        family: Name of the family, under which it is registered.
        episodes: The worlds.
        autoreset_mode: As above.

    Raises:
        ConfigError: There is no such mode.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["rgb_array"],
        "render_fps": 5,
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }
    family: str

    def __init__(self, episodes: Episodes, autoreset_mode: AutoresetMode | str = AutoresetMode.SAME_STEP) -> None:
        self.episodes: Any = episodes
        self.num_envs, self._worlds = episodes.envs, episodes.worlds
        self.render_mode = episodes.options.render_mode
        self.autoreset_mode = _checked_mode(autoreset_mode)
        self.metadata = {**type(self).metadata, "autoreset_mode": self.autoreset_mode}  # type: ignore[misc]
        self.single_observation_space = episodes.single_observation_space
        self.single_action_space = episodes.single_action_space
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._generators: list[np.random.Generator] = []
        self._ended = np.zeros(self.num_envs, np.bool_)

    @property
    def options(self) -> Any:
        """The checked keywords."""
        return self.episodes.options

    def reset(self, *, seed: Seeds = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        """Begin an episode in every world; a single seed ``s`` gives world ``i`` the seed ``s + i``.

        Args:
            seed: One, or one for each world.
            options: None, or Gymnasium's ``reset_mask``, (num_envs,) bool: only these environments begin anew, and only
                theirs are the infos.

        Raises:
            ConfigError: The number of seeds is not that of the worlds, or options that there are not.
        """
        seeds, mask = seeds_of(seed, self._worlds), self._mask_of(options)
        worlds = np.flatnonzero(mask.reshape(self._worlds, -1).any(axis=1)).tolist()
        before = self._generators
        self._generators = [
            before[world] if before and (one is None or world not in worlds) else seeding.np_random(one)[0]
            for world, one in enumerate(seeds)
        ]
        self._begin(worlds, seeds)
        return self.episodes.observe(), masked(self.episodes.infos(), mask)

    def _mask_of(self, options: dict[str, Any] | None) -> NDArray[np.bool_]:
        """Which environments ``reset`` begins anew: all, or those that the options name."""
        if not options:
            return np.ones(self.num_envs, np.bool_)
        for name in options:
            if name != "reset_mask":
                raise ConfigError(f"unknown option {name!r} of reset(){suggest(str(name), ['reset_mask'])}")
        mask = np.asarray(options["reset_mask"])
        if mask.shape != (self.num_envs,) or mask.dtype != np.bool_ or not mask.any():
            raise ConfigError(
                f"reset_mask = {options['reset_mask']!r} must be {self.num_envs} truth values, one of them True"
            )
        if not self._generators and not mask.all():
            raise ResetNeeded("a reset_mask needs running episodes; call reset() without one first")
        apart = mask.reshape(self._worlds, -1)
        if (apart.any(axis=1) != apart.all(axis=1)).any():
            raise ConfigError("reset_mask must be the same for all robots of a team, who begin together")
        return mask

    def _begin(self, worlds: list[int], seeds: Sequence[int | None] | None) -> None:
        self.episodes.reset(worlds, self._generators, seeds)
        self._ended.reshape(self._worlds, -1)[worlds] = False

    def step(self, actions: Any) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Act in every environment for one decision period.

        Raises:
            ActionError: An action that is NaN, out of range, or of the wrong shape or type.
            ResetNeeded: The environments were not reset, or, without autoreset, one whose episode has ended.
        """
        if not self._generators:
            raise ResetNeeded("step() needs running episodes; call reset() first")
        same_step = self.autoreset_mode == AutoresetMode.SAME_STEP
        rewards, terminated, truncated = self.episodes.step(actions) if same_step else self._step_running(actions)
        self._ended = terminated | truncated
        observations, endings = self.episodes.observe(), Info()
        if same_step and self._ended.any():
            done = self._ended.copy()
            endings = self._endings(observations, done)
            self._begin(self._worlds_of(done), None)
            overwrite(observations, self.episodes.observe(), done)
        infos = masked(self.episodes.infos(), np.ones(self.num_envs, np.bool_))
        infos.update(endings)
        return observations, rewards, terminated, truncated, infos

    def _step_running(self, actions: Any) -> Outcome:
        """Act where an episode is running, and begin the next one where the last step ended it."""
        over = self._ended.copy()
        if not over.any():
            outcome: Outcome = self.episodes.step(actions)
            return outcome
        if self.autoreset_mode == AutoresetMode.DISABLED:
            raise ResetNeeded(
                f"the episode of environment {int(np.argmax(over))} has ended; "
                "call reset(options={'reset_mask': mask}) for it before the next step()"
            )
        rewards, terminated, truncated = self.episodes.step(_without(actions, over))
        self._begin(self._worlds_of(over), None)  # what these worlds did is forgotten
        rewards[over], terminated[over], truncated[over] = 0.0, False, False
        return rewards, terminated, truncated

    def _worlds_of(self, environments: NDArray[np.bool_]) -> list[int]:
        each = environments
        if self._worlds != self.num_envs:
            each = np.logical_or.reduce(environments.reshape(self._worlds, -1), axis=1)
        found: list[int] = each.nonzero()[0].tolist()
        return found

    def _endings(self, observations: Any, done: NDArray[np.bool_]) -> Info:
        final = np.empty(self.num_envs, object)
        for one in done.nonzero()[0].tolist():
            final[one] = row_of(observations, one, copy=True)
        last = masked(self.episodes.last_infos(), done)
        return Info({"final_obs": final, "_final_obs": done.copy(), "final_info": last, "_final_info": done.copy()})

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """One picture a world; None without ``render_mode``.

        Raises:
            ResetNeeded: The environments were not reset.
        """
        if self.render_mode is None:
            return None
        if not self._generators:
            raise ResetNeeded("render() needs episodes; call reset() first")
        pictures = [self.episodes.picture(world) for world in range(self._worlds)]
        return tuple(picture for picture in pictures if picture is not None)

    def close_extras(self, **kwargs: Any) -> None:
        """Close the window, if there is one."""
        self.episodes.close()

    @property
    def restorable(self) -> bool:
        """Whether ``get_state`` is to be had; not where a user's own part of the worlds cannot be saved."""
        return bool(getattr(self.episodes, "restorable", True))

    def get_state(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, as arrays; ``set_state`` continues from there to the bit.

        Raises:
            ResetNeeded: The environments were not reset.
            LidarenaError: They are not ``restorable``; it says why.
        """
        if not self._generators:
            raise ResetNeeded("get_state() needs episodes; call reset() first")
        arrays = {name: array.copy() for name, array in self.episodes.arrays().items()}
        arrays["generators"] = np.stack([generator_words(rng) for rng in self._generators])
        return arrays if self.autoreset_mode == AutoresetMode.SAME_STEP else arrays | {"ended": self._ended.copy()}

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue where ``get_state`` of a batch with the same keywords and size was called."""
        self._generators = [generator_from_words(words) for words in state["generators"]]
        self._ended = state.get("ended", np.zeros(self.num_envs, np.bool_)).copy()
        self.episodes.load_arrays(state)


def whole_number_of_worlds(num_envs: Any) -> int:
    """Check the number of worlds.

    Raises:
        ConfigError: It is not a whole number of at least 1.
    """
    if isinstance(num_envs, bool) or not isinstance(num_envs, int | np.integer) or num_envs < 1:
        raise ConfigError(f"num_envs = {num_envs!r} must be a whole number of at least 1")
    return int(num_envs)


def _without(actions: Any, over: NDArray[np.bool_]) -> Any:
    """The actions with 0 for the environments whose episode has ended, since nobody looks at theirs."""
    try:
        table = np.array(actions)
    except ValueError:  # rows of different lengths, which the episodes refuse
        return actions
    if table.shape[:1] == over.shape:
        table[over] = 0
    return table


def _checked_mode(mode: AutoresetMode | str) -> AutoresetMode:
    words = {word: one for one in AutoresetMode for word in (one.value, one.name, one.name.lower())}
    if not isinstance(mode, AutoresetMode) and not (isinstance(mode, str) and mode in words):
        allowed = suggest(str(mode), [one.value for one in AutoresetMode])
        raise ConfigError(f"autoreset_mode = {mode!r} is not known{allowed}")
    chosen = mode if isinstance(mode, AutoresetMode) else words[mode]
    installed = tuple(int(part) for part in gym.__version__.split(".")[:2])
    if chosen == AutoresetMode.SAME_STEP and installed < _COUNTS_RIGHT:
        warnings.warn(
            f"the vector statistics of gymnasium {gym.__version__} count one step of an episode too few under "
            "AutoresetMode.SAME_STEP; make the batch with autoreset_mode='NextStep', or install gymnasium 1.4",
            stacklevel=4,
        )
    return chosen
