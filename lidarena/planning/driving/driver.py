"""Driving robots of many worlds to places on the maps that they believe in: ``Driver``'s steps, compiled."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, merged_kernel
from lidarena.planning.driving.following import (
    can_loiter,
    clear_queue,
    enqueue,
    has_queue,
    is_path_blocked,
    plan_commands,
    stays_clear,
)
from lidarena.planning.driving.state import ARRIVAL, Drive, DriverSettings, Perceptions
from lidarena.planning.driving.survey import look_around, points_around, remember_hits
from lidarena.planning.driving.whereabouts import find_way_back, has_no_way_back, note_whereabouts
from lidarena.planning.grid.grid_search import search_grid, trace


@kernel
def sense(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> None:
    """Take in a world's newest map, pose and scan."""
    is_new = remember_hits(w, senses, settings, drive)
    been, here = drive.been, drive.reckoned[w]
    note_whereabouts(w, here, senses.scans[w], is_new, has_queue(w, drive), settings.all_around, been)
    look_around(w, senses, settings, drive)


@kernel
def retreat(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> bool:
    """Give up the goal and drive back to where the robot came from; whether a way is found."""
    points = points_around(w, senses, settings, drive)
    angles, longest, keep = settings.angles, settings.max_range, settings.keep
    found = find_way_back(w, drive.reckoned[w], points, angles, longest, settings.commands, keep, drive.been)
    if len(found) == 0:
        return False
    stop(w, drive)
    enqueue(w, found, 0.0, drive)
    drive.been.retreats[w] = True
    return True


@merged_kernel
def retreats(w: int, drive: Drive) -> bool:
    """Whether the robot is on its way back to where it came from."""
    return bool(drive.been.retreats[w]) and has_queue(w, drive)


@merged_kernel
def is_cut_off(w: int, senses: Perceptions, drive: Drive) -> bool:
    """Whether the newest survey shows no way to where the robot came from."""
    ground = drive.ground
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    reachable = ground.reachable[w, : rows * columns].reshape(rows, columns)
    return bool(has_no_way_back(w, drive.reckoned[w], senses.poses[w], reachable, ground.frame[w], drive.been))


@merged_kernel
def stop(w: int, drive: Drive) -> None:
    """Give up the goal."""
    drive.has_goal[w] = False
    drive.path_points[w] = 0
    clear_queue(w, drive)


@merged_kernel
def has_arrived(w: int, senses: Perceptions, drive: Drive) -> bool:
    """Whether the robot is at its goal."""
    away = math.hypot(drive.goal[w, 0] - senses.poses[w, 0], drive.goal[w, 1] - senses.poses[w, 1])
    return bool(drive.has_goal[w]) and away <= ARRIVAL


@merged_kernel
def remaining_way(w: int, senses: Perceptions, drive: Drive) -> float:
    """What remains of the path, from its point nearest to the robot on [m]."""
    path = drive.path[w, : drive.path_points[w]]
    nearest, best = 0, np.inf
    for i in range(len(path)):
        away = math.hypot(path[i, 0] - senses.poses[w, 0], path[i, 1] - senses.poses[w, 1])
        if away < best:
            nearest, best = i, away
    total = 0.0
    for i in range(nearest + 1, len(path)):
        total += math.hypot(path[i, 0] - path[i - 1, 0], path[i, 1] - path[i - 1, 1])
    return total


@merged_kernel
def must_plan(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> bool:
    """Whether commands have run out before the goal, or something new stands in the way."""
    if not drive.has_goal[w] or has_arrived(w, senses, drive):
        return False
    if not has_queue(w, drive):
        return True
    return not stays_clear(w, senses, settings, drive) or is_path_blocked(w, senses, settings, drive)


@merged_kernel
def is_cornered(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> bool:
    """Whether the robot has no room to turn round where it is."""
    return not can_loiter(w, senses.poses[w], drive.near, settings)


@kernel
def go(w: int, x: float, y: float, senses: Perceptions, settings: DriverSettings, drive: Drive) -> bool:
    """Set out for a goal on the newest survey; whether there is a path and a first sequence of commands."""
    known = bool(drive.has_goal[w])
    same = known and math.hypot(x - drive.goal[w, 0], y - drive.goal[w, 1]) < settings.resolution
    if not (same and not is_path_blocked(w, senses, settings, drive)):
        path = _find(w, x, y, drive)
    else:
        path = drive.path[w, : drive.path_points[w]].copy()
    if len(path) == 0:
        return False
    if math.hypot(x - senses.poses[w, 0], y - senses.poses[w, 1]) <= ARRIVAL:
        clear_queue(w, drive)  # it is there; turning lets it look around
    elif not plan_commands(w, path, senses, settings, drive):
        return False
    drive.goal[w, 0], drive.goal[w, 1], drive.has_goal[w] = x, y, True
    drive.path_points[w] = len(path)
    drive.path[w, : len(path)] = path
    return True


@merged_kernel
def _find(w: int, x: float, y: float, drive: Drive) -> NDArray[np.float64]:
    """The cheapest way (n, 2) from the robot to a point, (0, 2) if there is none; cut short where it is very long."""
    ground, frame = drive.ground, drive.ground.frame[w]
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    row = min(max(math.floor((y - frame[1]) / frame[2]), 0), rows - 1)
    column = min(max(math.floor((x - frame[0]) / frame[2]), 0), columns - 1)
    cost = ground.cost[w, : rows * columns].reshape(rows, columns)
    start, goal = ground.cell[w, 0] * columns + ground.cell[w, 1], row * columns + column
    parent, reached = search_grid(cost, start, goal, True, 1.0)
    if not math.isfinite(reached[goal]):
        return np.empty((0, 2))
    cells = trace(parent, goal, columns)
    path = np.empty((min(len(cells), drive.path.shape[1]), 2))
    for i in range(len(path)):
        path[i, 0] = (cells[i, 1] + 0.5) * frame[2] + frame[0]
        path[i, 1] = (cells[i, 0] + 0.5) * frame[2] + frame[1]
    return path
