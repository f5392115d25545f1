"""Rows and episodes with chosen values, for the tests of tables and pictures."""

from collections.abc import Sequence

import numpy as np

from lidarena.evaluation.episodes import Episode
from lidarena.evaluation.measures import arena, corridor, exploration
from lidarena.evaluation.measures.table_columns import Measure
from lidarena.evaluation.picture import Picture
from lidarena.evaluation.progress_curve import ProgressCurve
from lidarena.evaluation.results import Row, summarise
from lidarena.evaluation.trace import BelievedMap, RobotTrace, Walls

TABLE = exploration.MEASURES.table
BY_NAME = {m.name: m for module in (arena, corridor, exploration) for m in module.MEASURES.table}
SQUARE = np.array([[0, 0, 4, 0], [4, 0, 4, 4], [4, 4, 0, 4], [0, 4, 0, 0]], dtype=float)


def row_of(policy: str, env: str = "Env-1", columns: tuple[Measure, ...] = TABLE, **values: Sequence[float]) -> Row:
    """A row from the values of each measure, one an episode."""
    count = len(next(iter(values.values())))
    assert all(len(column) == count for column in values.values())
    chosen = [{name: float(column[k]) for name, column in values.items()} for k in range(count)]
    return summarise(env, policy, [episode_of(k, measures, columns=columns) for k, measures in enumerate(chosen)])


def episode_of(
    seed: int,
    measures: dict[str, float],
    ending: str = "success",
    speed: float = 0.1,
    picture: Picture | None = None,
    columns: tuple[Measure, ...] = TABLE,
) -> Episode:
    """An episode that explores at a steady speed, a share per second, for ten seconds."""
    times = np.linspace(0, 10, 51)
    caption = f"{exploration.MEASURES.describe(measures)}: {ending}"
    progress = ProgressCurve.of(exploration.COMPLETENESS, times, speed * times)
    return Episode(seed, columns, measures, ending, caption, progress, picture)


def trace_of(grid: bool = True, walls: bool = True, crashed: bool = False) -> RobotTrace:
    """A quarter of a circle in a square room of 4 m."""
    angle = np.linspace(0, np.pi / 2, 40)
    path = np.column_stack([1 + 2 * np.sin(angle), 3 - 2 * np.cos(angle)])
    cells = np.full((80, 80), -1, dtype=np.int8)
    cells[10:60, 10:70] = 0
    cells[10, 10:70] = 100
    return RobotTrace(
        path,
        path + 0.05,
        Walls(SQUARE, np.array([[2.0, 2.0, 0.3]])) if walls else Walls(),
        BelievedMap(cells, 0.05, np.zeros(2)) if grid else None,
        crashed=crashed,
    )
