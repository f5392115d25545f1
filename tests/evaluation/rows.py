"""Rows and episodes with chosen values, for the tests of tables and pictures."""

from collections.abc import Sequence

import numpy as np

from lidarena.evaluation.episodes import Episode, Trace
from lidarena.evaluation.results import Row, summarise


def row_of(policy: str, env: str = "Env-1", **values: Sequence[float]) -> Row:
    """A row from the values of each measure, one an episode."""
    count = len(next(iter(values.values())))
    assert all(len(column) == count for column in values.values())
    chosen = [{name: float(column[k]) for name, column in values.items()} for k in range(count)]
    return summarise(env, policy, [episode_of(k, measures) for k, measures in enumerate(chosen)])


def episode_of(
    seed: int, measures: dict[str, float], ending: str = "success", speed: float = 0.1, trace: Trace | None = None
) -> Episode:
    """An episode that explores at a steady speed, a share per second, for ten seconds."""
    times = np.linspace(0, 10, 51)
    return Episode(seed, measures, ending, np.column_stack([times, speed * times]).astype(np.float32), trace)


def trace_of(grid: bool = True, walls: bool = True) -> Trace:
    """A quarter of a circle in a square room of 4 m."""
    angle = np.linspace(0, np.pi / 2, 40)
    path = np.column_stack([1 + 2 * np.sin(angle), 3 - 2 * np.cos(angle)])
    cells = np.full((80, 80), -1, dtype=np.int8)
    cells[10:60, 10:70] = 0
    cells[10, 10:70] = 100
    square = np.array([[0, 0, 4, 0], [4, 0, 4, 4], [4, 4, 0, 4], [0, 4, 0, 0]], dtype=float)
    return Trace(
        true=path,
        estimated=path + 0.05,
        grid=cells if grid else None,
        resolution=0.05,
        origin=np.zeros(2),
        edges=square if walls else np.empty((0, 4)),
        circles=np.array([[2.0, 2.0, 0.3]]) if walls else np.empty((0, 3)),
    )
