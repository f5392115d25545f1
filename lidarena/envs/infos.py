"""Infos and observations of batches: one world's part, and Gymnasium's masks.

Every family tells the same things by the same names: ``pose`` (3,) [m, m, rad], ``collision``, ``success``, ``time``
[s], ``path_length`` [m], ``radius`` of the robot [m] and ``reward_terms`` by name. Those of a team lead with an axis of
robots, or are told to each agent.
"""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

RENAMED = {
    "robot_radius": "radius",
    "poses": "pose",
    "goals": "goal",
    "arrived": "success",
    "collided": "collision",
    "path_lengths": "path_length",
}
"""Names of version 0.1 that still give their value, and what they are called now."""
_TERMS, _TERM = "reward_terms", "reward_"


class Info(dict[str, Any]):
    """What an environment tells beside observation and reward: a dictionary.

    A name that version 0.1 had is still found, with a ``DeprecationWarning``, though it is not among the keys. Where
    the reward's terms stand one by one, as PettingZoo's agents have them (``reward_progress``, …), ``reward_terms``
    gathers them.
    """

    def __missing__(self, name: str, level: int = 2) -> Any:
        now = self._name_now(name)
        if now is not None:
            words = f"info[{name!r}] is called info[{now!r}] now"
            warnings.warn(words, DeprecationWarning, stacklevel=level)
            return dict.__getitem__(self, now)
        if name == _TERMS and name in self:
            return {key.removeprefix(_TERM): value for key, value in self.items() if key.startswith(_TERM)}
        raise KeyError(name)

    def _name_now(self, name: str) -> str | None:
        """What a name of version 0.1 is called now, if the info has it; masks of batches too."""
        hidden = "_" if name.startswith("_") else ""
        now = hidden + RENAMED.get(name.removeprefix("_"), "")
        return now if now != hidden and dict.__contains__(self, now) else None

    def __contains__(self, name: object) -> bool:
        if dict.__contains__(self, name):
            return True
        if name == _TERMS:
            return any(key.startswith(_TERM) for key in self)
        return isinstance(name, str) and self._name_now(name) is not None

    def get(self, name: str, default: Any = None) -> Any:
        """Return the value of a name, or ``default``."""
        if dict.__contains__(self, name):
            return dict.__getitem__(self, name)
        return self.__missing__(name, level=3) if name in self else default

    def copy(self) -> "Info":
        """Return a shallow copy."""
        return Info(self)

    def __or__(self, other: dict[str, Any]) -> "Info":  # type: ignore[override]  # dict's own gives a plain dict
        return Info({**self, **other})


def of_world(info: dict[str, Any], world: int, copy: bool = False) -> Info:
    """One world's info out of a batch's; scalars become Python numbers.

    Args:
        info: Of the batch.
        world: Which one.
        copy: Whether its arrays share no memory with the batch's.
    """
    single = Info()
    for name, value in info.items():
        if isinstance(value, dict):
            single[name] = of_world(value, world, copy)
            continue
        item = value.item(world) if value.ndim == 1 else value[world]  # a Python number, or the object that is there
        single[name] = item.copy() if copy and isinstance(item, np.ndarray) else item
    return single


def masked(info: dict[str, Any], mask: NDArray[np.bool_]) -> Info:
    """Gymnasium's form of a batch's infos: beside every array one that says for which worlds it holds."""
    out = Info()
    for name, value in info.items():
        out[name] = masked(value, mask) if isinstance(value, dict) else value
        out["_" + name] = mask
    return out


def row_of(batch: Any, row: int, copy: bool = False) -> Any:
    """One environment's observation out of a batch of arrays or dictionaries of arrays."""
    if isinstance(batch, dict):
        return {name: row_of(array, row, copy) for name, array in batch.items()}
    return batch[row].copy() if copy else batch[row]


def overwrite(observations: Any, fresh: Any, rows: NDArray[np.bool_]) -> None:
    """Put the fresh observations of some environments into those of a batch."""
    if isinstance(observations, dict):
        for name, array in observations.items():
            array[rows] = fresh[name][rows]
    else:
        observations[rows] = fresh[rows]
