"""The columns of tables: names, units, and which direction is better; and those that every environment has."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from lidarena.base.errors import ConfigError, suggest


@dataclass(frozen=True)
class Measure:
    """One number per episode, and how tables show it.

    Attributes:
        name: Key in `results.json` and `table.csv`; values there are in SI units and fractions.
        title: Column heading, without the unit.
        unit: Shown in the heading, after multiplying by ``scale``; may be empty.
        scale: From the stored value to the shown one, such as 100 for per cent.
        stored_unit: Of `results.json` and `table.csv`; empty for a fraction, a count, or mixed units.
        better: Which direction is better; None where neither is.
        share: Every value is 0 or 1, so the interval is Wilson's.
        needs: Name of another measure that has to be level first: a policy that stops or crashes early drives the
            shortest path for nothing, so only those policies are compared whose mean of that measure cannot be told
            from the best one.
        main: In the short tables too, not only in `results.json`, `table.csv` and `table.md`.
        plane: Axis of the plane on which policies are drawn as points, where a family has two measures that are traded
            for each other; both are better low and positive.
        hint: What it says, in a few words for somebody new to it; on the plane's axis.
    """

    name: str
    title: str
    unit: str = ""
    scale: float = 1.0
    stored_unit: str = ""
    better: Literal["high", "low"] | None = None
    share: bool = False
    needs: str | None = None
    main: bool = False
    plane: Literal["across", "up"] | None = None
    hint: str = ""

    @property
    def label(self) -> str:
        """Title and unit, such as ``"Path (m)"``."""
        return f"{self.title} ({self.unit})" if self.unit else self.title

    @property
    def heading(self) -> str:
        """Title, unit and direction, such as ``"Path (m) ↓"``."""
        return f"{self.label} {self.arrow}".strip()

    @property
    def arrow(self) -> str:
        """The direction that is better; empty where neither is."""
        return {"high": "↑", "low": "↓", None: ""}[self.better]


SUCCESS = Measure("success", "Success", "%", 100, better="high", share=True, main=True)
COLLISION = Measure("collision", "Collision", "%", 100, better="low", share=True, main=True)
OUTCOME = (SUCCESS, COLLISION)
"""Of every environment whose info tells it; ahead of a family's columns, unless it places them itself."""
EFFORT = (
    Measure("return", "Return"),
    Measure("steps", "Steps"),
    Measure("decision_time", "Decision", "ms", 1000, "s"),
)
"""Of every environment; behind a family's columns."""


def whole_table(columns: Iterable[Measure]) -> tuple[Measure, ...]:
    """A family's columns with those of every environment around them, each name once.

    Raises:
        ConfigError: Two columns have one name, or one ``needs`` another that is not there.
    """
    own = tuple(columns)
    names = [column.name for column in own]
    table = (*(m for m in OUTCOME if m.name not in names), *own, *(m for m in EFFORT if m.name not in names))
    known = [column.name for column in table]
    for column in table:
        if known.count(column.name) > 1:
            raise ConfigError(f"two columns are named {column.name!r}; each needs a name of its own")
        if column.needs is not None and column.needs not in known:
            raise ConfigError(f"column {column.name!r} needs {column.needs!r}{suggest(column.needs, known)}")
    return table


def merged(tables: Iterable[Sequence[Measure]]) -> list[Measure]:
    """All columns of several tables, each once, as nearly as possible in the order of each."""
    columns: list[Measure] = []
    for table in tables:
        place = 0
        for column in table:
            if column not in columns:
                columns.insert(place, column)
            place = columns.index(column) + 1
    return columns
