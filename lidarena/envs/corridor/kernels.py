"""Kernels of the multi-robot worlds: the wheels' noise, who is near something, what everybody senses."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf, take_next
from lidarena.base.random_streams import normal, uniform
from lidarena.planning.team.moves import nearest_approach
from lidarena.world.lidar import Scanner, add_range_noise, cast_beams, scan_is_due
from lidarena.world.odometry import wrap
from lidarena.world.spaces import chord

LOOK_AHEAD = 4
"""Cells along the way at which the lookahead point lies that robots are shown."""
HALF_WAY = 2.0
"""Distance that is observed as 0.5 [m]."""
_MARGIN = 0.02
"""Robots that come so near to touching count as near [m]."""
_PIECE = 0.03
"""Ways are compared with walls at points at most so far apart [m]."""
_STALL = 3.0
"""Mean time for which a stalled robot stands [s]."""


class MotionNoise(NamedTuple):
    """How wheels disobey, per decision; see ``apply_motion_noise``.

    Attributes:
        speed_bias: Standard deviation of a robot's slowly changing error of speed, as a share of the speed.
        memory: Time in which that error changes [s].
        speed: Standard deviation of the speed, as a share of the speed.
        turn: Standard deviation of the turn rate, as a share of the turn rate.
        yaw_noise: Standard deviation of the turn rate, by speed [rad/m].
    """

    speed_bias: float = 0.15
    memory: float = 4.0
    speed: float = 0.1
    turn: float = 0.1
    yaw_noise: float = 0.15

    def scaled(self, factor: float) -> "MotionNoise":
        """The same with every deviation multiplied by ``factor``."""
        return MotionNoise(
            factor * self.speed_bias, self.memory, factor * self.speed, factor * self.turn, factor * self.yaw_noise
        )


class Ground(NamedTuple):
    """The floor on a fine and on a coarse grid.

    Attributes:
        clearance: (rows, cols) float32 distance of the cells' centres to the nearest surface [m], negative in walls.
        fine_origin: (2,) its lower-left corner [m].
        fine_cell: Its resolution [m].
        origin: (2,) lower-left corner of the grid that ways are on [m].
        cell: Its resolution [m].
    """

    clearance: NDArray[np.float32]
    fine_origin: NDArray[np.float64]
    fine_cell: float
    origin: NDArray[np.float64]
    cell: float


class TeamMeasurements(NamedTuple):
    """What ``W`` teams of ``R`` robots know.

    Attributes:
        ranges: (W, R, beams) exact ranges [m].
        scans: (W, R, beams) measured ranges, float32 [m].
        measured: (W, R, 3) poses as localisation in the known map gives them.
        velocity: (W, R, 2) speed [m/s] and turn rate [rad/s] of the last period.
        remaining: (W, R) length of the way to the goal, dearer near walls [m].
        lookahead_point: (W, R, 2) a point ahead on that way [m].
        closeness: (W, R) from 0 to 1: how near the nearest thing is, see ``CorridorEpisodes``.
        since_scan: (W,) time since the last scan [s].
    """

    ranges: NDArray[np.float64]
    scans: NDArray[np.float32]
    measured: NDArray[np.float64]
    velocity: NDArray[np.float64]
    remaining: NDArray[np.float64]
    lookahead_point: NDArray[np.float64]
    closeness: NDArray[np.float64]
    since_scan: NDArray[np.float64]


@leaf
def apply_motion_noise(
    commands: NDArray[np.float64],
    period: float,
    noise: MotionNoise,
    stall_rate: float,
    streams: NDArray[np.uint64],
    speed_bias: NDArray[np.float64],
    stalled: NDArray[np.float64],
) -> None:
    """Turn commands (W, R, 2), in place, into what the wheels do.

    The speed is (1 + e + n) v: e is a first-order Gauss-Markov process of its own for every robot (batteries, floor),
    n is white. The turn rate is that commanded plus white noise that grows with it and with the speed, as in the
    velocity motion model (Thrun, Burgard & Fox 2005, section 5.3). A robot at rest stays at rest. At random
    moments a robot stalls: it stands for an exponentially distributed time.

    Args:
        commands: (W, R, 2) [m/s, rad/s], changed.
        period: Of the decisions [s].
        noise: The deviations.
        stall_rate: [1/s].
        streams: (W, 4) random streams.
        speed_bias: (W, R) the errors e, changed.
        stalled: (W, R) how long each robot still stands [s], changed.
    """
    keep = math.exp(-period / noise.memory)
    fresh = noise.speed_bias * math.sqrt(1.0 - keep * keep)
    for w in range(commands.shape[0]):
        for r in range(commands.shape[1]):
            v, rate = commands[w, r, 0], commands[w, r, 1]
            speed_bias[w, r] = keep * speed_bias[w, r] + fresh * normal(streams[w])
            commands[w, r, 0] = v * max(1.0 + speed_bias[w, r] + noise.speed * normal(streams[w]), 0.0)
            commands[w, r, 1] = rate + (noise.turn * abs(rate) + noise.yaw_noise * abs(v)) * normal(streams[w])
            if stall_rate > 0.0:
                stalled[w, r] = max(stalled[w, r] - period, 0.0)
                if stalled[w, r] == 0.0 and uniform(streams[w]) < stall_rate * period:
                    stalled[w, r] = -_STALL * math.log(1.0 - uniform(streams[w]))
                if stalled[w, r] > 0.0:
                    commands[w, r, :] = 0.0


@inlined
def _passes_wall(
    x: float, y: float, theta: float, speed: float, rate: float, period: float, reach: float, ground: Ground
) -> bool:
    """Whether a robot's way of one period leads nearer than ``reach`` to a wall, or nearly so."""
    rows, cols = ground.clearance.shape
    vx, vy = chord(theta, speed, rate, period)
    pieces = 1 + int(abs(speed) * period / _PIECE)
    slack = 0.75 * ground.fine_cell + 0.5 * _PIECE  # the robot is somewhere in the cell, and between two samples
    for k in range(pieces + 1):
        when = period * k / pieces
        row = math.floor((y + when * vy - ground.fine_origin[1]) / ground.fine_cell)
        col = math.floor((x + when * vx - ground.fine_origin[0]) / ground.fine_cell)
        row, col = min(max(row, 0), rows - 1), min(max(col, 0), cols - 1)
        if ground.clearance[row, col] < reach + slack:
            return True
    return False


@leaf
def find_near(
    commands: NDArray[np.float64],
    period: float,
    radius: float,
    cornered: bool,
    poses: NDArray[np.float64],
    ground: Ground,
    near: NDArray[np.bool_],
) -> None:
    """Mark in ``near`` (W, R) the robots that may touch a wall or a robot in the next ``period``; see ``TeamPhysics``.

    ``cornered``: robots have an outline within ``radius``, and may touch by turning, which discs cannot.
    Two robots are near each other if they come closer than their radii and a margin on the straight lines that they are
    about to drive; and with them is near who could be reached by a robot that a contact drives off its line.
    """
    for w in range(poses.shape[0]):
        fastest = 0.0
        for r in range(poses.shape[1]):
            v, rate = commands[w, r, 0], commands[w, r, 1]
            fastest = max(fastest, abs(v))
            x, y, theta = poses[w, r, 0], poses[w, r, 1], poses[w, r, 2]
            moves = v != 0.0 or (cornered and rate != 0.0)
            near[w, r] = moves and _passes_wall(x, y, theta, v, rate, period, radius + _MARGIN, ground)
        touch, reach = 2.0 * radius + _MARGIN, 2.0 * (radius + fastest * period) + _MARGIN
        for r in range(poses.shape[1]):
            for other in range(r):
                dx, dy = poses[w, other, 0] - poses[w, r, 0], poses[w, other, 1] - poses[w, r, 1]
                if dx * dx + dy * dy > reach * reach:
                    continue
                ax, ay = chord(poses[w, r, 2], commands[w, r, 0], commands[w, r, 1], period)
                bx, by = chord(poses[w, other, 2], commands[w, other, 0], commands[w, other, 1], period)
                when = period * nearest_approach(dx, dy, (bx - ax) * period, (by - ay) * period)
                dx, dy = dx + when * (bx - ax), dy + when * (by - ay)
                moves = ax != 0.0 or ay != 0.0 or bx != 0.0 or by != 0.0
                moves = moves or (cornered and (commands[w, r, 1] != 0.0 or commands[w, other, 1] != 0.0))
                if dx * dx + dy * dy < touch * touch and moves:
                    near[w, r] = True
                    near[w, other] = True
        _spread(poses, w, reach, near)


@leaf
def _spread(poses: NDArray[np.float64], w: int, reach: float, near: NDArray[np.bool_]) -> None:
    """Mark in ``near`` (W, R) whoever of world ``w`` is within ``reach`` of a marked robot, and so on."""
    spreading = True
    while spreading:
        spreading = False
        for r in range(poses.shape[1]):
            for other in range(poses.shape[1]):
                if near[w, r] and not near[w, other]:
                    dx, dy = poses[w, r, 0] - poses[w, other, 0], poses[w, r, 1] - poses[w, other, 1]
                    if dx * dx + dy * dy < reach * reach:
                        near[w, other] = spreading = True


@inlined
def _way_cell(field: NDArray[np.float32], x: float, y: float, ground: Ground) -> tuple[int, int, float]:
    """The cell through which a point's way leads, and how long the way is [m]; row -1 if there is none around."""
    rows, cols = field.shape
    row, col = math.floor((y - ground.origin[1]) / ground.cell), math.floor((x - ground.origin[0]) / ground.cell)
    best_row, best_col, best = -1, -1, 1e9
    for dr in range(-1, 2):
        for dc in range(-1, 2):
            r, c = row + dr, col + dc
            if 0 <= r < rows and 0 <= c < cols and field[r, c] < 1e9:
                cx, cy = ground.origin[0] + (c + 0.5) * ground.cell, ground.origin[1] + (r + 0.5) * ground.cell
                length = field[r, c] + math.hypot(cx - x, cy - y)
                if length < best:
                    best_row, best_col, best = r, c, length
    return best_row, best_col, best


@leaf
def distance_to_goal(
    field: NDArray[np.float32],
    goal: NDArray[np.float64],
    x: float,
    y: float,
    ground: Ground,
    before: float,
    lookahead_point: NDArray[np.float64],
) -> float:
    """Length of the way from a point to the goal [m]; ``lookahead_point`` (2,) gets a point ahead on it.

    Args:
        field: (rows, cols) length of the way from every cell's centre [m], 1e9 in walls.
        goal: (2,) where it ends.
        x: Of the point.
        y: Of the point.
        ground: Where the cells are.
        before: What is returned where no way begins nearby, with the goal itself as the point ahead.
        lookahead_point: Output.
    """
    lookahead_point[0], lookahead_point[1] = goal[0], goal[1]
    row, col, length = _way_cell(field, x, y, ground)
    straight = math.hypot(goal[0] - x, goal[1] - y)
    if straight < 2.0 * ground.cell:
        return straight
    if row < 0:
        return before
    for _ in range(LOOK_AHEAD):
        best_row, best_col = row, col
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                r, c = row + dr, col + dc
                inside = 0 <= r < field.shape[0] and 0 <= c < field.shape[1]
                if inside and field[r, c] < field[best_row, best_col]:
                    best_row, best_col = r, c
        if best_row == row and best_col == col:
            return length  # the goal's cell: the lookahead point is the goal
        row, col = best_row, best_col
    lookahead_point[0] = ground.origin[0] + (col + 0.5) * ground.cell
    lookahead_point[1] = ground.origin[1] + (row + 0.5) * ground.cell
    return length


class TeamMotion(NamedTuple):
    """What robots have done in a decision period.

    Attributes:
        before: (W, R, 3) poses before it.
        poses: (W, R, 3) poses now.
        streams: (W, 4) random streams.
        fuzz: Standard deviation of the measured poses [m, rad].
        period: [s].
    """

    before: NDArray[np.float64]
    poses: NDArray[np.float64]
    streams: NDArray[np.uint64]
    fuzz: float
    period: float


class Ways(NamedTuple):
    """How far it is from everywhere to each robot's goal.

    Attributes:
        ground: The floor.
        fields: (W, R, rows, cols) each robot's lengths of the way [m].
        goals: (W, R, 2) [m].
    """

    ground: Ground
    fields: NDArray[np.float32]
    goals: NDArray[np.float64]


@leaf
def sense(
    counter: NDArray[np.int64],
    last: int,
    motion: TeamMotion,
    radius: float,
    outline: NDArray[np.float64],
    scanner: Scanner,
    ways: Ways,
    measurements: TeamMeasurements,
) -> None:
    """Fill ``measurements`` of one world after another, taken from ``counter`` (1,) up to ``last``.

    Args:
        counter: Shared by the threads.
        last: World after the last.
        motion: What the robots have done.
        radius: Of the robots [m].
        outline: (n, 2) their corners [m]; (0, 2) for discs.
        scanner: The lidars.
        ways: To the goals.
        measurements: Output.
    """
    before, poses, streams, fuzz, period = motion
    lidar, geometry, directions, plan = scanner
    ground, fields, goals = ways
    w = take_next(counter)
    while w < last:
        cast_beams(w, w + 1, poses, plan, radius, outline, geometry, directions, lidar, measurements.ranges)
        if scan_is_due(w, period, lidar, measurements.since_scan):
            add_range_noise(w, w + 1, lidar, streams, measurements.ranges, measurements.scans)
        for r in range(poses.shape[1]):
            for k in range(3):
                measurements.measured[w, r, k] = poses[w, r, k] + (fuzz * normal(streams[w]) if fuzz > 0.0 else 0.0)
            measurements.measured[w, r, 2] = wrap(measurements.measured[w, r, 2])
            dx, dy = poses[w, r, 0] - before[w, r, 0], poses[w, r, 1] - before[w, r, 1]
            middle = before[w, r, 2] + 0.5 * wrap(poses[w, r, 2] - before[w, r, 2])
            measurements.velocity[w, r, 0] = (dx * math.cos(middle) + dy * math.sin(middle)) / period
            measurements.velocity[w, r, 1] = wrap(poses[w, r, 2] - before[w, r, 2]) / period
            x, y = measurements.measured[w, r, 0], measurements.measured[w, r, 1]
            measurements.remaining[w, r] = distance_to_goal(
                fields[w, r],
                goals[w, r],
                x,
                y,
                ground,
                measurements.remaining[w, r],
                measurements.lookahead_point[w, r],
            )
            least = lidar.max_range
            for k in range(measurements.ranges.shape[2]):
                least = min(least, measurements.ranges[w, r, k])
            measurements.closeness[w, r] = min(max(1.0 - (least - radius) / (2.0 * radius), 0.0), 1.0)
        w = take_next(counter)


@inlined
def _write_direction(
    out: NDArray[np.float32], at: int, pose: NDArray[np.float64], target: NDArray[np.float64], length: float
) -> None:
    """Three numbers from ``at`` on: cos and sin of the bearing of a point, and length / (length + ``HALF_WAY``)."""
    dx, dy = target[0] - pose[0], target[1] - pose[1]
    away = math.sqrt(dx * dx + dy * dy)
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    if away > 0.0:
        out[at] = min(max((dx * cos + dy * sin) / away, -1.0), 1.0)
        out[at + 1] = min(max((dy * cos - dx * sin) / away, -1.0), 1.0)
    else:
        out[at], out[at + 1] = 1.0, 0.0
    out[at + 2] = length / (length + HALF_WAY)


@leaf
def write_observations(
    measurements: TeamMeasurements,
    goals: NDArray[np.float64],
    finished: NDArray[np.bool_],
    max_range: float,
    top: NDArray[np.float64],
    neighbours: int,
    out: NDArray[np.float32],
) -> None:
    """Fill ``out`` (W, R, beams + 8 + 5 neighbours); see ``corridor_v0``. Robots that ``finished`` (W, R) see zeros.

    ``top`` (2,): the speed and turn rate that are observed as 1.
    """
    beams = measurements.scans.shape[2]
    for w in range(out.shape[0]):
        for r in range(out.shape[1]):
            row = out[w, r]
            if finished[w, r]:
                row[:] = 0.0
                continue
            pose = measurements.measured[w, r]
            for k in range(beams):
                row[k] = measurements.scans[w, r, k] / max_range
            away = math.hypot(goals[w, r, 0] - pose[0], goals[w, r, 1] - pose[1])
            _write_direction(row, beams, pose, goals[w, r], away)
            for k in range(2):
                row[beams + 3 + k] = min(max(measurements.velocity[w, r, k] / top[k], -1.0), 1.0)
            _write_direction(row, beams + 5, pose, measurements.lookahead_point[w, r], measurements.remaining[w, r])
            _write_neighbours(
                measurements.measured[w], measurements.velocity[w], r, neighbours, top[0], row[beams + 8 :]
            )


@leaf
def _write_neighbours(
    poses: NDArray[np.float64],
    velocity: NDArray[np.float64],
    robot: int,
    neighbours: int,
    top: float,
    out: NDArray[np.float32],
) -> None:
    """Five numbers for each of a robot's nearest neighbours, the nearest first; zeros where there is none.

    Bearing cos, sin; d / (d + 2 m); relative velocity along and across the robot's heading, over twice ``top``.
    """
    out[:] = 0.0
    pose, last, before = poses[robot], -1.0, -1
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    for n in range(min(neighbours, poses.shape[0] - 1)):
        nearest, least = -1, 1e18
        for other in range(poses.shape[0]):
            dx, dy = poses[other, 0] - pose[0], poses[other, 1] - pose[1]
            square = dx * dx + dy * dy
            later = square > last or (square == last and other > before)  # of equally near ones the first by number
            if other != robot and later and square < least:
                nearest, least = other, square
        if nearest < 0:
            return
        last, before = least, nearest
        _write_direction(out, 5 * n, pose, poses[nearest], math.sqrt(least))
        vx = velocity[nearest, 0] * math.cos(poses[nearest, 2]) - velocity[robot, 0] * cos
        vy = velocity[nearest, 0] * math.sin(poses[nearest, 2]) - velocity[robot, 0] * sin
        out[5 * n + 3] = min(max((vx * cos + vy * sin) / (2.0 * top), -1.0), 1.0)
        out[5 * n + 4] = min(max((vy * cos - vx * sin) / (2.0 * top), -1.0), 1.0)
