"""Scenario files of the MovingAI benchmarks for teams (Stern et al. 2019): who starts where and goes where."""

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ScenarioError


class TeamScenario(NamedTuple):
    """Starts and goals, (k, 2) [row, column] each, with row 0 at the smallest y as in ``load_movingai``."""

    starts: NDArray[np.int64]
    goals: NDArray[np.int64]


def load_scenario(
    path: str | os.PathLike[str], free: NDArray[np.bool_], robots: int | None = None, map_name: str | None = None
) -> TeamScenario:
    """Read the first robots of a ``.scen`` file.

    Args:
        path: The file.
        free: (rows, cols) passable cells of its map, from ``load_movingai``.
        robots: How many; None = all.
        map_name: Name of the map's file without folders, if it is to be compared with the one in the scenario.

    Raises:
        ScenarioError: The file is missing or torn, belongs to another map, has too few robots, or has a start or
            goal in a wall; or fewer than one robot is asked for.
    """
    where = f"scenario {os.fspath(path)!r}"
    try:
        lines = Path(path).read_text(encoding="ascii").splitlines()
    except OSError as error:
        raise ScenarioError(f"{where} cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{where} is not a MovingAI scenario: it holds a byte that is not ASCII text") from error
    if not lines or lines[0].split()[:1] != ["version"]:
        raise ScenarioError(f"{where} is not a MovingAI scenario: its first line must be 'version 1'")
    entries = [(number, line) for number, line in enumerate(lines[1:], start=2) if line.strip()]
    if robots is not None and not 1 <= robots <= len(entries):
        raise ScenarioError(f"{where} has starts for {len(entries)} robots; {robots} are asked for")
    rows = [_read_entry(where, number, line, free.shape, map_name) for number, line in entries[:robots]]
    ends = np.array(rows, np.int64).reshape(-1, 2, 2)
    ends[:, :, 0] = free.shape[0] - 1 - ends[:, :, 0]
    for robot, kind in np.argwhere(~free[ends[:, :, 0], ends[:, :, 1]]):
        x, y = ends[robot, kind, 1], free.shape[0] - 1 - ends[robot, kind, 0]
        raise ScenarioError(
            f"{where} has the {('start', 'goal')[kind]} of robot {robot} at x = {x}, y = {y},"
            " which is a wall of this map"
        )
    return TeamScenario(ends[:, 0].copy(), ends[:, 1].copy())


def _read_entry(
    where: str, number: int, line: str, shape: tuple[int, ...], map_name: str | None
) -> list[tuple[int, int]]:
    """Start and goal of one line as (y, x), y counted from the top as in the file."""
    fields = line.split()
    try:
        name, (width, height, *ends) = fields[1], [int(field) for field in fields[2:8]]
        start_x, start_y, goal_x, goal_y = ends
        float(fields[8])
    except (IndexError, ValueError) as error:
        raise ScenarioError(
            f"{where} is torn in line {number}: nine fields (bucket, map, width, height, start x, start y, goal x,"
            f" goal y, length) are needed, not {line.strip()[:60]!r}"
        ) from error
    if (height, width) != shape:
        raise ScenarioError(
            f"{where} is for a map of {width} x {height} cells ({name!r}); the map given has {shape[1]} x {shape[0]}"
        )
    if map_name is not None and Path(name).name != map_name:
        raise ScenarioError(f"{where} is for the map {name!r}; the map given is {map_name!r}")
    for x, y in ((start_x, start_y), (goal_x, goal_y)):
        if not (0 <= x < width and 0 <= y < height):
            raise ScenarioError(f"{where} has x = {x}, y = {y} in line {number}, outside of {width} x {height} cells")
    return [(start_y, start_x), (goal_y, goal_x)]
