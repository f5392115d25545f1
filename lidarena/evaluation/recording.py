"""What is noted while an episode runs, for a family to measure and draw afterwards."""

from collections.abc import Iterable, Mapping
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.baselines import Policy

Env = gym.Env[Any, Any]
Floats = NDArray[np.float64]


class Recording:
    """One episode as it was driven.

    Args:
        env: The environment.
        policy: Who drives.
        kept: Entries of ``info`` that are noted at the reset and after every step; a dot leads into an entry that is
            itself a dictionary, as in ``"truth.pose"``.

    Attributes:
        env: The environment, as it is at the end.
        policy: The policy, as it is at the end.
        info: The last info, with the truth.
        rewards: Of each step.
        decision_times: Of each decision [s].
        terminated: Whether the environment ended the episode.
        truncated: Whether it was cut off.
        step_limit: Steps after which it would have been cut off; infinite if never.
        ending: Why it ended, see ``FamilyMeasures.ending``.
    """

    def __init__(self, env: Env, policy: Policy, kept: Iterable[str] = ()) -> None:
        self.env, self.policy = env, policy
        self.info: Mapping[str, Any] = {}
        self.rewards: list[float] = []
        self.decision_times: list[float] = []
        self.terminated = self.truncated = False
        self.step_limit = float("inf")
        self.ending = ""
        self._history: dict[str, list[Floats]] = {name: [] for name in kept}

    @property
    def steps(self) -> int:
        """Number of steps that were taken."""
        return len(self.rewards)

    def note(self, info: Mapping[str, Any]) -> None:
        """Copy what changes from step to step, since the environment may reuse its arrays; numbers become floats."""
        self.info = info
        for name, entries in self._history.items():
            value = entry_of(info, name)
            entries.append(np.array(np.nan if value is None else value, dtype=np.float64))

    def series(self, name: str) -> Floats:
        """What was kept of an entry, ``(steps + 1, …)``: the reset's comes first; NaN where it was not told."""
        return np.stack(np.broadcast_arrays(*self._history[name]))

    def steps_of(self, name: str) -> Floats:
        """The same after each step; the reset's only if no step was taken."""
        series = self.series(name)
        return series[1:] if len(series) > 1 else series

    def positions(self, name: str) -> Floats:
        """The x and y of a kept pose, ``(steps + 1, 2)``, or a team's, ``(steps + 1, robots, 2)``; NaN if not told."""
        series = self.series(name)
        return np.full((len(series), 2), np.nan) if series.ndim == 1 else series[..., :2]


def entry_of(info: Mapping[str, Any], name: str) -> Any:
    """Look up ``"a.b"`` in nested dictionaries; None if it is not there."""
    value: Any = info
    for key in name.split("."):
        value = value.get(key) if isinstance(value, Mapping) else None
    return value
