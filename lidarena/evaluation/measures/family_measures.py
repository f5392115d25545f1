"""How the episodes of a family are measured, tabulated and drawn; a family of one's own derives from this.

    # in my_module.py; the family is registered with measures="my_module:MEASURES"
    MEASURES = FamilyMeasures([Measure("crossings", "Crossings", better="high", main=True)])

fills a column from the entry ``crossings`` of each episode's last info. Overriding the methods does the rest.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from lidarena.base.errors import ConfigError, suggest
from lidarena.base.import_names import import_named
from lidarena.envs.registration import family_named, family_of
from lidarena.evaluation.measures.table_columns import EFFORT, Measure, whole_table
from lidarena.evaluation.picture import Picture
from lidarena.evaluation.progress_curve import ProgressCurve
from lidarena.evaluation.recording import Recording

UNTIMED_DECISIONS = 5
"""Decisions at the start of an episode whose time is not counted: they load compiled code."""


class FamilyMeasures:
    """What an evaluation asks of a family; as it stands, what every environment tells.

    Args:
        columns: In place of the class's.

    Attributes:
        columns: Of the tables; ``success``, ``collision``, ``return``, ``steps`` and ``decision_time`` are added
            where they are not among them. A column that ``measure`` does not give is the entry of the last info by the
            column's name.
        kept: Entries of ``info`` that a ``Recording`` keeps of every step.
    """

    columns: tuple[Measure, ...] = ()
    kept: tuple[str, ...] = ()

    def __init__(self, columns: Iterable[Measure] | None = None) -> None:
        if columns is not None:
            self.columns = tuple(columns)

    @property
    def table(self) -> tuple[Measure, ...]:
        """All columns, in the order of the table.

        Raises:
            ConfigError: Columns that no table can have.
        """
        return whole_table(self.columns)

    def measure(self, recording: Recording) -> Mapping[str, float]:
        """Measure a finished episode: values of columns by name, NaN for what it does not tell."""
        return {}

    def picture(self, recording: Recording) -> Picture | None:
        """What is to be drawn of a finished episode; None if nothing is."""
        return None

    def progress(self, recording: Recording) -> ProgressCurve | None:
        """What rose or fell over the time of a finished episode; None if nothing is to be drawn of it."""
        return None

    def describe(self, values: Mapping[str, float]) -> str:
        """What a picture's title says of an episode besides how it ended, such as ``"explored 97% in 31 m"``."""
        return ""

    def ending(self, recording: Recording) -> str:
        """Why an episode ended.

        Returns:
            ``collision``, ``success``, ``terminated``, ``out of time`` or ``policy finished``; a family may have
            others.
        """
        if np.any(recording.info.get("collision", False)):
            return "collision"
        if recording.terminated:
            return "success" if np.all(recording.info.get("success", False)) else "terminated"
        return "out of time" if recording.truncated else "policy finished"

    def values(self, recording: Recording) -> dict[str, float]:
        """Measure a finished episode in every column.

        Raises:
            ConfigError: ``measure`` gave a value that no column has the name of.
        """
        names = [column.name for column in self.table]
        own = self.measure(recording)
        for name in own:
            if name not in names:
                raise ConfigError(f"a measure is named {name!r}, which is no column{suggest(name, names)}")
        found = _of_every_environment(recording) | dict(own)
        found |= {name: _number(recording.info.get(name)) for name in names if name not in found}
        return {name: float(found[name]) for name in names}


_OF_NO_FAMILY = FamilyMeasures([replace(column, main=True) for column in EFFORT])


def measures_of(env: Any) -> FamilyMeasures:
    """Return the measures of an environment's family; those of every environment if it belongs to none.

    Raises:
        ConfigError: The family is not registered, or tells measures that are not there.
    """
    name = family_of(env)
    path = None if name is None else family_named(name).measures
    if path is None:
        return _OF_NO_FAMILY
    try:
        found = import_named(path, f"measures of the family {name!r}")
    except ImportError as error:
        raise ConfigError(f"measures {path!r} of the family {name!r} cannot be imported: {error}") from error
    if not isinstance(found, FamilyMeasures):
        raise ConfigError(
            f"measures {path!r} of the family {name!r} are a {type(found).__name__}, where a FamilyMeasures is needed"
        )
    return found


def _of_every_environment(recording: Recording) -> dict[str, float]:
    told = {name: name in recording.info for name in ("success", "collision")}
    return {
        "success": float(recording.ending == "success") if told["success"] else np.nan,
        "collision": float(recording.ending == "collision") if told["collision"] else np.nan,
        "return": float(np.sum(recording.rewards)),
        "steps": float(recording.steps),
        "decision_time": float(np.mean(recording.decision_times[UNTIMED_DECISIONS:] or recording.decision_times)),
    }


def _number(value: Any) -> float:
    """An entry of ``info`` as a number; NaN if it is none."""
    array = np.asarray(value)
    return float(array) if array.ndim == 0 and array.dtype.kind in "biuf" else np.nan
