"""Following a path with a handful of commands, compiled: what ``path_following.PathFollower`` does, for many worlds."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, merged_kernel
from lidarena.planning.driving.state import Drive, DriverSettings, KnownGround, Perceptions
from lidarena.planning.driving.survey import points_around
from lidarena.planning.grid.guard import is_safe, turn_in_place, way_out
from lidarena.planning.grid.path_following import (
    END_REACH,
    LOOKAHEAD,
    REACH,
    TOLERANCE,
    lookahead_point,
    path_is_blocked,
)
from lidarena.planning.grid.steering import WEIGHT, WINDOW, loiter_gap, move, search_commands, tightest
from lidarena.planning.grid.surroundings import gap_at

_HORIZON = 8  # commands that are checked ahead
_MOST_STATES = 6000.0


@merged_kernel
def _gap(ground: KnownGround, w: int) -> NDArray[np.float32]:
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    return ground.gap[w, : rows * columns].reshape(rows, columns)


@merged_kernel
def _closed(ground: KnownGround, w: int) -> NDArray[np.bool_]:
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    return ground.closed[w, : rows * columns].reshape(rows, columns)


@merged_kernel
def _queue(w: int, drive: Drive) -> NDArray[np.int64]:
    return drive.queue[w, drive.queue_span[w, 0] : drive.queue_span[w, 1]]


@merged_kernel
def clear_queue(w: int, drive: Drive) -> None:
    """Forget the commands that are still to come."""
    drive.queue_span[w, 0] = drive.queue_span[w, 1] = 0


@merged_kernel
def has_queue(w: int, drive: Drive) -> bool:
    """Whether commands are still to come."""
    return bool(drive.queue_span[w, 1] > drive.queue_span[w, 0])


@merged_kernel
def is_clear(
    w: int, pose: NDArray[np.float64], ground: KnownGround, settings: DriverSettings, drive: Drive, n: int
) -> bool:
    """Whether the next n planned commands keep the clearance that they were planned with, or that which there is."""
    gap, closed, frame = _gap(ground, w), _closed(ground, w), ground.frame[w]
    here = gap_at(gap, closed, frame, pose[0], pose[1])
    least = tightest(gap, closed, frame, pose, settings.commands.moves, _queue(w, drive)[:n])
    return bool(least >= min(drive.kept[w] - TOLERANCE, max(here, 0.0) - 0.01))


@merged_kernel
def stays_clear(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> bool:
    """Whether the next planned commands keep clear of what is near."""
    return is_clear(w, senses.poses[w], drive.near, settings, drive, _HORIZON)


@merged_kernel
def _room(w: int, command: int, pose: NDArray[np.float64], ground: KnownGround, settings: DriverSettings) -> float:
    velocity = settings.commands.velocities[command]
    return loiter_gap(_gap(ground, w), _closed(ground, w), ground.frame[w], pose, velocity)


@merged_kernel
def can_loiter(w: int, pose: NDArray[np.float64], ground: KnownGround, settings: DriverSettings) -> bool:
    """Whether there is room to drive a circle, in narrow places."""
    most = -np.inf
    for k in range(settings.commands.velocities.shape[0]):
        if settings.commands.velocities[k, 1] != 0.0:
            most = max(most, _room(w, k, pose, ground, settings))
    return bool(most >= settings.margins[1])


@merged_kernel
def next_command(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> int:
    """The next planned command if what the beams have hit says that it is safe, else a turn, or the way out."""
    points = points_around(w, senses, settings, drive)
    if has_queue(w, drive) and not is_safe(points, settings.commands, _queue(w, drive), settings.keep):
        clear_queue(w, drive)
    if not has_queue(w, drive):
        commands, keep, room = settings.commands, settings.keep, settings.margins[0]
        drive.turning[w] = turn_in_place(points, commands, drive.turning[w], keep, room)
        drive.given[w] = drive.turning[w]
        if drive.turning[w] >= 0:
            return int(drive.turning[w])
        enqueue(w, way_out(points, commands, keep), 0.0, drive)
    drive.turning[w] = -1
    if has_queue(w, drive):
        drive.given[w] = drive.queue[w, drive.queue_span[w, 0]]
        drive.queue_span[w, 0] += 1
    else:
        drive.given[w] = turn_in_place(points, settings.commands, -1, 0.0, settings.margins[0])
    return int(drive.given[w])


@merged_kernel
def enqueue(w: int, sequence: NDArray[np.int64], kept: float, drive: Drive) -> None:
    """Plan a sequence (n,) of commands that is meant to keep a clearance [m]."""
    count = min(len(sequence), drive.queue.shape[1])
    drive.queue[w, :count] = sequence[:count]
    drive.queue_span[w, 0], drive.queue_span[w, 1], drive.kept[w] = 0, count, kept


@merged_kernel
def _leads_to(
    w: int, path: NDArray[np.float64], pose: NDArray[np.float64], settings: DriverSettings, drive: Drive
) -> bool:
    """Whether the planned commands end where they would be planned to now, as they do while the robot turns."""
    ground, queue = drive.ground, _queue(w, drive)
    gap, closed, frame = _gap(ground, w), _closed(ground, w), ground.frame[w]
    index = lookahead_point(path, pose, gap, closed, frame, LOOKAHEAD, settings.margins[0])
    here = pose.copy()
    for command in queue:
        move(here, settings.commands.moves[command])
    near = math.hypot(here[0] - path[index, 0], here[1] - path[index, 1]) <= REACH
    return near and is_clear(w, pose, ground, settings, drive, len(queue))


@kernel
def _towards(
    w: int,
    path: NDArray[np.float64],
    pose: NDArray[np.float64],
    settings: DriverSettings,
    drive: Drive,
    points: NDArray[np.float64],
    margin: float,
    lookahead: float,
) -> bool:
    """Search commands along a path and queue them; whether there are any that are safe."""
    ground = drive.ground
    gap, closed, frame = _gap(ground, w), _closed(ground, w), ground.frame[w]
    index = lookahead_point(path, pose, gap, closed, frame, lookahead, margin)
    reach = END_REACH if index == len(path) - 1 else REACH
    here = gap_at(gap, closed, frame, pose[0], pose[1])
    margins = np.array([min(margin, max(here, 0.0) - 0.01), settings.margins[3], WEIGHT])
    limits = np.array([reach, WINDOW, _MOST_STATES])
    found = search_commands(gap, closed, frame, pose, path[index], settings.commands, margins, limits)
    if len(found) == 0 or not is_safe(points, settings.commands, found, settings.keep):
        return False
    enqueue(w, found, margin, drive)
    return True


@kernel
def plan_commands(
    w: int, path: NDArray[np.float64], senses: Perceptions, settings: DriverSettings, drive: Drive
) -> bool:
    """Queue commands along a path (n, 2), n >= 1; what was queued before stays if it serves or nothing is found."""
    pose, margins = senses.poses[w], settings.margins
    if has_queue(w, drive) and _leads_to(w, path, pose, settings, drive):
        return True
    points = points_around(w, senses, settings, drive)
    found = _towards(w, path, pose, settings, drive, points, margins[0], LOOKAHEAD)
    found = found or _towards(w, path, pose, settings, drive, points, margins[1], LOOKAHEAD)
    found = found or _towards(w, path, pose, settings, drive, points, margins[1], 2.0 * LOOKAHEAD)
    found = found or _towards(w, path, pose, settings, drive, points, margins[1], 0.5 * LOOKAHEAD)
    if not found and not can_loiter(w, pose, drive.ground, settings):
        found = _towards(w, path, pose, settings, drive, points, margins[2], 0.5 * LOOKAHEAD)
    return found


@merged_kernel
def is_path_blocked(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> bool:
    """Whether there is no path, or what is near blocks it."""
    count = drive.path_points[w]
    if count == 0:
        return True
    near = drive.near
    gap, closed, path = _gap(near, w), _closed(near, w), drive.path[w, :count]
    return path_is_blocked(path, senses.poses[w], gap, closed, near.frame[w], settings.margins[1])
