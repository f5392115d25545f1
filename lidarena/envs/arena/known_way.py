"""The way to the goal through what a robot has seen so far, and how long each heading stays free: ``"way"``'s kernels.

Nothing here knows more than the lidar has told since the episode began. The way is looked for again where something
has come in between, where the robot has left it, and every few steps in any case.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.envs.arena.actions import HEADINGS
from lidarena.envs.arena.scan_tracks import ScanTracks, track
from lidarena.envs.arena.seen_map import (
    BLOCKED,
    CELLS,
    SeenMap,
    cell_of,
    is_clear,
    nearest_cell,
    note_free,
    note_hit,
)
from lidarena.planning.grid.known_ways import SearchSpace, search_way, trace_way
from lidarena.world.lidar import LidarSpec

HORIZON = 8.0
"""How far ahead it is told whether a heading stays free [steps]."""
EXTRAS = 3 + HEADINGS
"""Numbers in the observation ``"way"`` beside those of ``"proximity"``."""
_LONGEST = 1024
"""Cells of a way that are remembered."""
_AGE = 8
"""Steps after which a way is looked for again."""
_AWAY = 5.0
"""A robot has left its way so far from it [cells]."""
_AHEAD = 7.0
"""The lookahead point lies at most so far along the way [steps]."""
_SPARE = 0.05
"""Room that free headings have beside the robot [steps]."""
_STANDS = 0.1
"""What a beam has met goes into the map if it moves no faster [steps a decision]."""


class KnownWays(NamedTuple):
    """The ways of ``W`` robots.

    Attributes:
        cells: (W, L) the way, from where it was found to the goal, as row · N + column.
        dear: (W, L) what each of them cost when it was found.
        rest: (W, L) length of the way from each of them to the goal [m].
        number: (W,) cells of the way.
        at: (W,) number of the cell beside the robot.
        age: (W,) steps since it was found.
        point: (W, 2) the lookahead point: the farthest in a straight line along the way [m].
        length: (W,) of the way from the robot by that point to the goal [m].
        approach: (W,) to the lookahead point in the last step [m].
        free: (W, headings) steps for which the robot could drive on each heading, at most ``HORIZON``.
        drives: (W, headings, 2) what a step on each heading is [m].
    """

    cells: NDArray[np.int32]
    dear: NDArray[np.uint8]
    rest: NDArray[np.float32]
    number: NDArray[np.int64]
    at: NDArray[np.int64]
    age: NDArray[np.int64]
    point: NDArray[np.float64]
    length: NDArray[np.float64]
    approach: NDArray[np.float64]
    free: NDArray[np.float64]
    drives: NDArray[np.float64]


def no_ways(worlds: int) -> KnownWays:
    """Ways that are still to be found."""
    shape = (worlds, _LONGEST)
    return KnownWays(
        np.zeros(shape, np.int32),
        np.zeros(shape, np.uint8),
        np.zeros(shape, np.float32),
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.int64),
        np.zeros((worlds, 2)),
        np.zeros(worlds),
        np.zeros(worlds),
        np.zeros((worlds, HEADINGS)),
        np.zeros((worlds, HEADINGS, 2)),
    )


class Knowledge(NamedTuple):
    """What ``W`` robots know: maps, moving discs, ways; and memory to search with."""

    seen: SeenMap
    tracks: ScanTracks
    ways: KnownWays
    space: SearchSpace


@leaf
def _map_scan(
    world: int, pose: NDArray[np.float64], ranges: NDArray[np.float32], step: float, lidar: LidarSpec, known: Knowledge
) -> None:
    """Bring a scan into the map: first what beams have passed, then what they have met, unless it moves."""
    ends, group, motion, seen = (
        known.tracks.ends[world],
        known.tracks.group[world],
        known.tracks.motion[world],
        known.seen,
    )
    for k in range(len(ranges)):
        length = np.float64(ranges[k])
        if length > 0.0:
            cos, sin = (ends[k, 0] - pose[0]) / length, (ends[k, 1] - pose[1]) / length
            note_free(world, pose[0], pose[1], cos, sin, length, seen)
    slow = (_STANDS * step) ** 2
    for k in range(len(ranges)):
        if group[k] >= 0 and motion[k, 0] ** 2 + motion[k, 1] ** 2 <= slow:
            note_hit(world, ends[k, 0], ends[k, 1], seen)


@leaf
def _find_way(world: int, pose: NDArray[np.float64], goal: NDArray[np.float64], known: Knowledge) -> None:
    """Look for the way from where the robot is."""
    ways, seen = known.ways, known.seen
    start, end = nearest_cell(pose[0], pose[1], world, seen), nearest_cell(goal[0], goal[1], world, seen)
    search_way(seen.cost[world], start, end, known.space)
    whole = trace_way(start, end, known.space, ways.cells[world])
    count = min(whole, ways.cells.shape[1])
    columns, cell = seen.cost.shape[2], seen.cell[world]
    length = (whole - count) * cell
    for k in range(count - 1, -1, -1):
        here = ways.cells[world, k]
        if k + 1 < count:
            apart = abs(here - ways.cells[world, k + 1])
            length += cell * (1.0 if apart == 1 or apart == columns else math.sqrt(2.0))
        ways.rest[world, k] = length
        ways.dear[world, k] = seen.cost[world, here // columns, here % columns]
    ways.number[world], ways.at[world], ways.age[world] = count, 0, 0


@leaf
def _is_blocked(world: int, known: Knowledge) -> bool:
    """Whether something has come near the way ahead since it was found."""
    ways, cost = known.ways, known.seen.cost[world]
    for k in range(ways.at[world], ways.number[world]):
        here = ways.cells[world, k]
        dear = cost[here // cost.shape[1], here % cost.shape[1]]
        if dear >= BLOCKED and dear > ways.dear[world, k]:
            return True
    return False


@inlined
def _middle(cell: int, world: int, seen: SeenMap) -> tuple[float, float]:
    """The middle of a cell [m]."""
    columns, side = seen.cost.shape[2], seen.cell[world]
    x = seen.origin[world, 0] + (cell % columns + 0.5) * side
    return x, seen.origin[world, 1] + (cell // columns + 0.5) * side


@leaf
def _go_along(world: int, pose: NDArray[np.float64], known: Knowledge) -> bool:
    """Find the cell of the way that is beside the robot; whether it is near enough."""
    ways, seen = known.ways, known.seen
    least, best = math.inf, ways.at[world]
    for k in range(ways.at[world], min(ways.at[world] + 24, ways.number[world])):
        x, y = _middle(ways.cells[world, k], world, seen)
        away = (x - pose[0]) ** 2 + (y - pose[1]) ** 2
        if away <= least:
            least, best = away, k
    ways.at[world] = best
    return bool(least < (_AWAY * seen.cell[world]) ** 2)


@leaf
def _look_ahead(
    world: int, pose: NDArray[np.float64], goal: NDArray[np.float64], reach: float, known: Knowledge
) -> None:
    """Set the lookahead point: the farthest one along the way to which a straight line is no dearer than the way."""
    ways, seen = known.ways, known.seen
    first, last = ways.at[world], ways.number[world] - 1
    columns = seen.cost.shape[2]
    ways.point[world, 0], ways.point[world, 1], dear, k = goal[0], goal[1], 1, first
    ways.length[world] = math.sqrt((goal[0] - pose[0]) ** 2 + (goal[1] - pose[1]) ** 2)
    if first >= last:
        return
    chosen = min(first + 1, last)
    while k < last and ways.rest[world, first] - ways.rest[world, k] < reach:
        k += 1
        here = ways.cells[world, k]
        dear = max(dear, int(seen.cost[world, here // columns, here % columns]))
        x, y = _middle(here, world, seen)
        if k == last:
            x, y = goal[0], goal[1]
        if is_clear(world, pose[0], pose[1], x, y, dear, seen):
            chosen = k
    x, y = _middle(ways.cells[world, chosen], world, seen)
    if chosen == last and last + 1 < ways.cells.shape[1]:
        x, y = goal[0], goal[1]
    ways.point[world, 0], ways.point[world, 1] = x, y
    ways.length[world] = math.sqrt((x - pose[0]) ** 2 + (y - pose[1]) ** 2) + ways.rest[world, chosen]


@leaf
def time_to_meet(dx: float, dy: float, vx: float, vy: float, radius: float) -> float:
    """When a point at (dx, dy) comes within ``radius`` that closes in with (vx, vy) a step; inf if never.

    A point that is nearer than that already is met at once, unless it draws away.
    """
    along, speed = vx * dx + vy * dy, vx * vx + vy * vy
    gap = dx * dx + dy * dy - radius * radius
    if along <= 0.0 or speed <= 0.0:
        return math.inf
    if gap <= 0.0:
        return 0.0
    root = along * along - speed * gap
    return (along - math.sqrt(root)) / speed if root >= 0.0 else math.inf


@leaf
def _mind(
    world: int, dx: float, dy: float, motion: tuple[float, float], reach: float, radius: float, ways: KnownWays
) -> None:
    """Shorten the times for which headings stay free by those at which they lead to a point within ``reach``."""
    if dx * dx + dy * dy > reach * reach:
        return
    free, drives = ways.free[world], ways.drives[world]
    for k in range(len(free)):
        free[k] = min(free[k], time_to_meet(dx, dy, drives[k, 0] - motion[0], drives[k, 1] - motion[1], radius))


@leaf
def _measure_free(
    world: int, pose: NDArray[np.float64], step: float, radius: float, scans: float, known: Knowledge
) -> None:
    """Measure for how many steps each heading stays free of what the map has, and of what the beams meet."""
    ways, seen, tracks = known.ways, known.seen, known.tracks
    for k in range(HEADINGS):
        angle = pose[2] + k * (2.0 * math.pi / HEADINGS)
        ways.drives[world, k, 0], ways.drives[world, k, 1] = step * math.cos(angle), step * math.sin(angle)
        ways.free[world, k] = HORIZON
    near = radius + _SPARE * step
    reach = near + HORIZON * step
    around = math.ceil(reach / seen.cell[world])
    row, column = cell_of(pose[0], pose[1], world, seen)
    for r in range(max(row - around, 0), min(row + around + 1, seen.cost.shape[1])):
        for c in range(max(column - around, 0), min(column + around + 1, seen.cost.shape[2])):
            if seen.trust[world, r, c]:
                dx, dy = seen.points[world, r, c, 0] - pose[0], seen.points[world, r, c, 1] - pose[1]
                _mind(world, dx, dy, (0.0, 0.0), reach, near, ways)
    for k in range(tracks.ends.shape[1]):
        if tracks.group[world, k] >= 0:
            dx, dy = tracks.ends[world, k, 0] - pose[0], tracks.ends[world, k, 1] - pose[1]
            motion = (tracks.motion[world, k, 0] / scans, tracks.motion[world, k, 1] / scans)
            _mind(world, dx, dy, motion, 3.0 * reach, near, ways)


class Moves(NamedTuple):
    """What ``W`` robots have done in a step, and with what.

    Attributes:
        before: (W, 1, 3) poses before it.
        poses: (W, 1, 3) poses now.
        goals: (W, 2) [m].
        radii: (W,) of the robots [m].
        scans: (W, 1, beams) what the lidars measure [m].
        fresh: (W,) whether that is new.
        step: What a robot drives in a decision [m].
        decisions: Between two scans, at least 1.
        directions: (2, beams) cos and sin of the beams' angles.
        lidar: Of the robots.
    """

    before: NDArray[np.float64]
    poses: NDArray[np.float64]
    goals: NDArray[np.float64]
    radii: NDArray[np.float64]
    scans: NDArray[np.float32]
    fresh: NDArray[np.bool_]
    step: float
    decisions: float
    directions: NDArray[np.float64]
    lidar: LidarSpec


@leaf
def learn(first: int, last: int, moves: Moves, known: Knowledge) -> None:
    """Let the robots of worlds first … last - 1 make of a scan what they can, and find their ways.

    Args:
        first: World.
        last: World after the last.
        moves: What they did.
        known: Changed.
    """
    ways = known.ways
    for world in range(first, last):
        pose, goal, point = moves.poses[world, 0], moves.goals[world], ways.point[world]
        old = moves.before[world, 0]
        was = math.sqrt((point[0] - old[0]) ** 2 + (point[1] - old[1]) ** 2)
        ways.approach[world] = was - math.sqrt((point[0] - pose[0]) ** 2 + (point[1] - pose[1]) ** 2)
        if moves.fresh[world]:
            scan = moves.scans[world, 0]
            track(world, pose, scan, moves.step, moves.directions, moves.lidar, known.tracks)
            _map_scan(world, pose, scan, moves.step, moves.lidar, known)
        ways.age[world] += 1
        lost = ways.number[world] == 0 or ways.age[world] >= _AGE or not _go_along(world, pose, known)
        if lost or _is_blocked(world, known):
            _find_way(world, pose, goal, known)
        _look_ahead(world, pose, goal, _AHEAD * moves.step, known)
        _measure_free(world, pose, moves.step, moves.radii[world], moves.decisions, known)


def way_ahead(world: int, known: Knowledge) -> NDArray[np.float64]:
    """The way (n, 2) from a robot's lookahead point on, as far as it is remembered [m]."""
    ways, seen = known.ways, known.seen
    cells = ways.cells[world, ways.at[world] : ways.number[world]]
    middles = seen.origin[world] + (np.stack([cells % CELLS, cells // CELLS], axis=1) + 0.5) * seen.cell[world]
    beyond = int(np.argmin(np.hypot(*(middles - ways.point[world]).T))) + 1 if len(cells) else 0
    return np.vstack([ways.point[world], middles[beyond:]])


@leaf
def observe_way(poses: NDArray[np.float64], side: float, ways: KnownWays, out: NDArray[np.float32]) -> None:
    """Write what ``"way"`` shows beside ``"proximity"`` into the last ``EXTRAS`` columns.

    Args:
        poses: (W, 1, 3).
        side: Lengths are given over this [m].
        ways: Of the worlds.
        out: (W, n) output: length, cosine and sine of the lookahead point's bearing, and for each heading 0 where it
            stays free for ``HORIZON`` steps, to 1 where it leads to contact at once.
    """
    at = out.shape[1] - EXTRAS
    for w in range(out.shape[0]):
        x, y = ways.point[w, 0] - poses[w, 0, 0], ways.point[w, 1] - poses[w, 0, 1]
        away = math.sqrt(x * x + y * y)
        cos, sin = math.cos(poses[w, 0, 2]), math.sin(poses[w, 0, 2])
        out[w, at] = min(ways.length[w] / side, 1.0)
        out[w, at + 1] = min(max((x * cos + y * sin) / away, -1.0), 1.0) if away > 0.0 else 1.0
        out[w, at + 2] = min(max((y * cos - x * sin) / away, -1.0), 1.0) if away > 0.0 else 0.0
        for k in range(HEADINGS):
            out[w, at + 3 + k] = (HORIZON - ways.free[w, k]) / (HORIZON * (1.0 + ways.free[w, k]))
