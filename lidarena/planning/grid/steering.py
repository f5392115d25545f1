"""Which commands take a robot that cannot stop or reverse to a point nearby: best-first search over command sequences.

The robot knows a handful of commands (v, w), each held for one decision period. An edge of the search repeats one
command until it makes a difference (some 0.1 m or 0.18 rad); states fall into bins of position and heading; the cost is
the time, more near obstacles. Turning costs its true time, so a robot that turns slowly is sent straight.

A sequence must end where the robot could *loiter*: turn a full circle, left or right, without touching anything. So
a robot that has followed a sequence to its end, and finds no further one, is still safe. For DA-SLAM's robot, which
turns on an arc of 0.167 m, this is what forbids driving up to a wall: facing it at 0.28 m, no command avoids it.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.heap import pop, push
from lidarena.base.jit import kernel
from lidarena.planning.grid.surroundings import Surroundings, gap_at

_BIN = 0.07  # side of a position bin (m)
_TURN_EDGE, _DRIVE_EDGE = 0.18, 0.1  # what one edge of the search turns (rad) or drives (m), at least one command
_TWO_PI = 2.0 * math.pi
WEIGHT, WINDOW = 10.0, 2.5
"""A second with no clearance at all counts as 1 + the first seconds; half the side of the square searched [m]."""


class Commands(NamedTuple):
    """A robot's commands; row k of every array belongs to command k.

    Attributes:
        velocities: (k, 2) v (m/s, forwards), w (rad/s, to the left).
        period: How long a command is held (s).
        moves: (k, 3) what a command does in the robot's frame: dx, dy (m), dtheta (rad).
        repeats: (k,) how often an edge of the search repeats it.
    """

    velocities: NDArray[np.float64]
    period: float
    moves: NDArray[np.float64]
    repeats: NDArray[np.int64]

    @classmethod
    def of(cls, velocities: NDArray[np.float64] | list[tuple[float, float]], period: float) -> "Commands":
        """Return the commands for rows of (v, w), each held for ``period`` seconds on an exact arc.

        Raises:
            ConfigError: for a period or velocities that are not finite and positive, or no command that drives or none
                that turns.
        """
        rows = np.array(velocities, dtype=np.float64).reshape(-1, 2)  # a copy: kernels are compiled for writable ones
        if not 0.0 < period < math.inf or not np.isfinite(rows).all() or (rows[:, 0] < 0.0).any():
            raise ConfigError(
                f"commands {rows.tolist()} held for {period} s, allowed are finite v >= 0 and a period > 0"
            )
        if not (rows[:, 0] > 0.0).any() or not (rows[:, 1] != 0.0).any():
            raise ConfigError(f"commands {rows.tolist()}, at least one must drive and one must turn")
        turn = rows[:, 1] * period
        # sin(a)/a and (1 - cos(a))/a without the division by zero
        ahead, aside = np.sinc(turn / np.pi), np.sin(turn / 2) * np.sinc(turn / _TWO_PI)
        drive = rows[:, 0] * period
        moves = np.stack([drive * ahead, drive * aside, turn], axis=1)
        per_edge = np.maximum(np.abs(turn) / _TURN_EDGE, drive / _DRIVE_EDGE)
        return cls(rows, period, moves, np.maximum(1, np.round(1.0 / per_edge)).astype(np.int64))


@kernel
def move(pose: NDArray[np.float64], step: NDArray[np.float64]) -> None:
    """Drive ``pose`` (3,) by ``step`` (3,) given in its own frame, in place; the heading is not wrapped."""
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    pose[0] += cosine * step[0] - sine * step[1]
    pose[1] += sine * step[0] + cosine * step[1]
    pose[2] += step[2]


@kernel
def tightest(
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
    frame: NDArray[np.float64],
    pose: NDArray[np.float64],
    moves: NDArray[np.float64],
    sequence: NDArray[np.int64],
) -> float:
    """Return the least clearance (m) that the robot meets when it executes a sequence of commands from a pose.

    Args:
        gap: (rows, cols) clearance of the cells (m).
        closed: (rows, cols) cells that are forbidden.
        frame: (3,) x, y of the origin, side of a cell.
        pose: (3,) x, y, theta; not counted itself.
        moves: (k, 3) what each command does.
        sequence: (n,) indices of commands.

    Returns:
        The least of the clearances after each command; -1 if one lies in a closed cell, inf for no commands.
    """
    here = pose.copy()
    least = np.inf
    for command in sequence:
        move(here, moves[command])
        least = min(least, gap_at(gap, closed, frame, here[0], here[1]))
    return float(least)


@kernel
def loiter_gap(
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
    frame: NDArray[np.float64],
    pose: NDArray[np.float64],
    velocity: NDArray[np.float64],
) -> float:
    """Return the least clearance (m) on a full circle driven with one turning command.

    Args:
        gap: (rows, cols) clearance of the cells (m).
        closed: (rows, cols) cells that are forbidden.
        frame: (3,) x, y of the origin, side of a cell.
        pose: (3,) x, y, theta.
        velocity: (2,) v (m/s) and w (rad/s), w not 0.
    """
    radius = velocity[0] / velocity[1]  # signed: positive to the left
    x = pose[0] - radius * math.sin(pose[2])
    y = pose[1] + radius * math.cos(pose[2])
    least = np.inf
    for i in range(16 if radius != 0.0 else 1):
        angle = pose[2] + i * _TWO_PI / 16
        least = min(least, gap_at(gap, closed, frame, x + radius * math.sin(angle), y - radius * math.cos(angle)))
    return float(least)


@kernel
def _can_loiter(
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
    frame: NDArray[np.float64],
    pose: NDArray[np.float64],
    velocities: NDArray[np.float64],
    margin: float,
) -> bool:
    for k in range(velocities.shape[0]):
        w = velocities[k, 1]
        if w != 0.0 and loiter_gap(gap, closed, frame, pose, velocities[k]) >= margin:
            return True
    return False


@kernel
def _ahead(
    pose: NDArray[np.float64], target: NDArray[np.float64], reach: float, velocities: NDArray[np.float64]
) -> float:
    """Seconds at least to come within ``reach`` of ``target``: turn towards its disc, drive straight."""
    speed, rate = 0.0, 0.0
    for k in range(velocities.shape[0]):
        speed, rate = max(speed, velocities[k, 0]), max(rate, abs(velocities[k, 1]))
    dx, dy = target[0] - pose[0], target[1] - pose[1]
    distance = math.hypot(dx, dy)
    if distance <= reach:
        return 0.0
    error = abs((math.atan2(dy, dx) - pose[2] + math.pi) % _TWO_PI - math.pi)
    seconds: float = (distance - reach) / speed + max(error - math.asin(reach / distance), 0.0) / rate
    return seconds


@kernel
def _drive_edge(
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
    frame: NDArray[np.float64],
    pose: NDArray[np.float64],
    step: NDArray[np.float64],
    repeat: int,
    margins: NDArray[np.float64],
) -> float:
    """Drive ``pose`` along one edge, in place; its cost in commands, inf where it comes too near to an obstacle.

    ``margins`` (3,): least clearance, clearance from which a place costs nothing extra (m), weight of the extra.
    """
    cost = 0.0
    for _ in range(repeat):
        move(pose, step)
        least = gap_at(gap, closed, frame, pose[0], pose[1])
        if least < margins[0]:
            return np.inf
        lack = max(margins[1] - least, 0.0) / margins[1]
        cost += 1.0 + margins[2] * lack * lack
    return cost


@kernel
def _bin(pose: NDArray[np.float64], centre: NDArray[np.float64], side: int, headings: int) -> int:
    """The bin of ``pose`` in a square of ``side`` bins around ``centre`` with ``headings`` headings; -1 outside."""
    col = math.floor((pose[0] - centre[0]) / _BIN) + side // 2
    row = math.floor((pose[1] - centre[1]) / _BIN) + side // 2
    if row < 0 or row >= side or col < 0 or col >= side:
        return -1
    turn = int((pose[2] % _TWO_PI) / _TWO_PI * headings) % headings
    return int((row * side + col) * headings + turn)


@kernel
def search_commands(
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
    frame: NDArray[np.float64],
    start: NDArray[np.float64],
    target: NDArray[np.float64],
    commands: Commands,
    margins: NDArray[np.float64],
    limits: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Return the quickest commands to a target nearby, (n,) indices, (0,) if there are none; see :func:`steer`.

    Args:
        gap: (rows, cols) clearance of the cells (m).
        closed: (rows, cols) cells that are forbidden.
        frame: (3,) x, y of the origin, side of a cell.
        start: (3,) x, y, theta.
        target: (2,) x, y.
        commands: What the robot can do.
        margins: (3,) least clearance, preferred clearance (m), weight of the lack of it.
        limits: (3,) distance to the target that counts as there (m), half the side of the square that is searched (m),
            states that are looked at, at most.
    """
    velocities, moves = commands.velocities, commands.moves
    reach, side, most = limits[0], 2 * int(limits[1] / _BIN) + 1, int(limits[2])
    headings = math.ceil(_TWO_PI / max(_TURN_EDGE, np.abs(moves[:, 2]).max()) - 1e-6)
    table = np.full(side * side * headings, -1, np.int32)
    poses, spent, done, here = np.empty((most, 3)), np.zeros(most), np.zeros(most, np.bool_), np.empty(3)
    before = np.full((most, 2), -1, np.int64)
    heap, where, keys = np.empty(most, np.int64), np.full(most, -1, np.int64), np.empty(most)
    poses[0] = start
    keys[0] = _ahead(start, target, reach, velocities)
    table[_bin(start, start, side, headings)] = 0
    count, size = 1, push(heap, where, keys, 0, 0)
    while size > 0:
        node, size = pop(heap, where, keys, size), size - 1
        done[node] = True
        near = math.hypot(poses[node, 0] - target[0], poses[node, 1] - target[1]) <= reach
        if near and node > 0 and _can_loiter(gap, closed, frame, poses[node], velocities, margins[0]):
            return _unroll(before, commands.repeats, node)
        for k in range(moves.shape[0]):
            here[:] = poses[node]
            cost = _drive_edge(gap, closed, frame, here, moves[k], commands.repeats[k], margins)
            slot = _bin(here, start, side, headings)
            if cost == np.inf or slot < 0:
                continue
            cost = spent[node] + cost * commands.period
            other = table[slot]
            if other < 0:
                if count == most:
                    return np.empty(0, np.int64)
                other, count = count, count + 1
                table[slot] = other
            elif done[other] or spent[other] <= cost:
                continue
            poses[other], spent[other] = here, cost
            before[other, 0], before[other, 1] = node, k
            keys[other] = cost + _ahead(here, target, reach, velocities)
            size = push(heap, where, keys, size, other)
    return np.empty(0, np.int64)


@kernel
def _unroll(before: NDArray[np.int64], repeats: NDArray[np.int64], node: int) -> NDArray[np.int64]:
    n = 0
    at = node
    while before[at, 0] >= 0:
        n += repeats[before[at, 1]]
        at = before[at, 0]
    sequence = np.empty(n, np.int64)
    at = node
    while before[at, 0] >= 0:
        command = before[at, 1]
        sequence[n - repeats[command] : n] = command
        n -= repeats[command]
        at = before[at, 0]
    return sequence


def steer(
    around: Surroundings,
    pose: NDArray[np.float64],
    target: tuple[float, float],
    commands: Commands,
    margin: float = 0.17,
    preferred: float = 0.4,
    weight: float = WEIGHT,
    reach: float = 0.15,
    window: float = WINDOW,
    most_states: int = 6_000,
) -> NDArray[np.int64]:
    """Return the quickest sequence of commands that leads near a target, through places with clearance.

    Args:
        around: The robot's surroundings.
        pose: (3,) x, y, theta. It may be nearer to an obstacle than ``margin``; the way must then not lead any nearer.
        target: x, y (m).
        commands: What the robot can do.
        margin: Least clearance of every pose on the way, and of a circle that could be driven at its end (m).
        preferred: Clearance from which a place costs nothing extra (m).
        weight: A second with no clearance at all counts as 1 + ``weight`` seconds; falls with the square.
        reach: How near to the target is there (m).
        window: Half the side of the square around the robot that is searched (m).
        most_states: The search gives up after as many states.

    Returns:
        (n,) indices of commands; (0,) if nothing was found.
    """
    at = np.asarray(pose, np.float64)
    frame = around.frame
    here = gap_at(around.gap, around.closed, frame, at[0], at[1])
    margins = np.array([min(margin, max(here, 0.0) - 0.01), preferred, weight])
    sequence: NDArray[np.int64] = search_commands(
        around.gap,
        around.closed,
        frame,
        at,
        np.asarray(target, np.float64),
        commands,
        margins,
        np.array([reach, window, float(most_states)]),
    )
    return sequence
