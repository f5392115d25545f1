"""Random walks of a team over a grid, and the conflicts of two of them as the definition says."""

from typing import NamedTuple

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from lidarena.planning.team.grid_graph import GridGraph
from tests.planning.team.problems import meet


class Walks(NamedTuple):
    """Paths (k, capacity) of places, valid up to ``lengths`` (k,)."""

    graph: GridGraph
    paths: np.ndarray
    lengths: np.ndarray


@st.composite
def walks(draw: st.DrawFn, robots: int = 3, most: int = 9) -> Walks:
    """Walks without goals over a grid with a few blocked cells; they may conflict."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    radius = draw(st.sampled_from([0.0, 0.0, 0.5, 0.8]))
    blocked = rng.random((6, 7)) < draw(st.sampled_from([0.0, 0.15]))
    blocked[2:4, 2:5] = False
    graph = GridGraph(blocked, draw(st.sampled_from([4, 8])), radius)
    assume(len(graph))
    paths = np.zeros((robots, most + 4), np.int32)
    lengths = rng.integers(0, most + 1, robots)
    for robot in range(robots):
        paths[robot, 0] = rng.integers(len(graph))
        for t in range(lengths[robot]):
            around = graph.neighbours[paths[robot, t]]
            paths[robot, t + 1] = rng.choice(around[around >= 0])
    return Walks(graph, paths, lengths)


def cell(team: Walks, robot: int, t: int) -> tuple[int, int]:
    """Where a robot is at a time; it stays where its walk ends."""
    row, col = team.graph.cells[team.paths[robot, min(t, team.lengths[robot])]]
    return int(row), int(col)


def conflicts(team: Walks, one: int, other: int, t: int) -> bool:
    """Whether two robots meet in the step from ``t`` on."""
    ends = (cell(team, one, t), cell(team, other, t), cell(team, one, t + 1), cell(team, other, t + 1))
    return meet(*ends, team.graph.apart)
