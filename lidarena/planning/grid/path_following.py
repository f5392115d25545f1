"""Driving along a grid path with a handful of commands, without touching what the map shows.

At every planning instant the follower looks for the farthest point of the path that lies within ``lookahead`` and in
free sight, and lets ``steering.steer`` search the quickest safe commands to it. Between those
instants it executes them one by one, having checked from the robot's *actual* pose that they still keep clear. As the
search is optimal, planning again from a pose on the old sequence finds its rest: nothing swings to and fro.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel
from lidarena.planning.grid.guard import is_safe
from lidarena.planning.grid.steering import Commands, loiter_gap, move, steer, tightest
from lidarena.planning.grid.surroundings import Surroundings, gap_at, line_is_free

_SHORTEST_CARROT = 0.4  # the lookahead point lies at least so far ahead on the path, in sight or not (m)
TOLERANCE = 0.03
"""So much less clearance than planned is no reason to replan: poses jitter [m]."""
LOOKAHEAD, REACH, END_REACH = 1.5, 0.15, 0.25
"""How far along the path commands are searched; how near to the path's point is there, and to the path's end [m]."""
_SHORTEST_LOOK = 0.2  # nearer to the robot a path is not checked (m)


@kernel
def _nearest_point(path: NDArray[np.float64], position: NDArray[np.float64]) -> int:
    nearest, best = 0, np.inf
    for i in range(path.shape[0]):
        distance = math.hypot(path[i, 0] - position[0], path[i, 1] - position[1])
        if distance <= best:
            nearest, best = i, distance
    return nearest


@kernel
def lookahead_point(
    path: NDArray[np.float64],
    position: NDArray[np.float64],
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
    frame: NDArray[np.float64],
    lookahead: float,
    margin: float,
) -> int:
    """Return the index of the path's point to steer for.

    Args:
        path: (n, 2) x, y (m), n >= 1.
        position: (2,) or longer, x, y of the robot.
        gap: (rows, cols) clearance of the cells (m).
        closed: (rows, cols) cells that are forbidden.
        frame: (3,) x, y of the origin, side of a cell.
        lookahead: How far along the path to look, counted from the point nearest to the robot (m).
        margin: Clearance (m) of a line of sight.

    Returns:
        The farthest point in sight within ``lookahead``, at the least the one ``0.4`` m ahead.
    """
    nearest = _nearest_point(path, position)
    chosen, travelled = nearest, 0.0
    for i in range(nearest + 1, path.shape[0]):
        travelled += math.hypot(path[i, 0] - path[i - 1, 0], path[i, 1] - path[i - 1, 1])
        if travelled > lookahead:
            break
        if travelled <= _SHORTEST_CARROT or line_is_free(gap, closed, frame, position, path[i], margin):
            chosen = i
    return chosen


@dataclass
class PathFollower:
    """Turns a path into commands; keep one for the whole drive.

    Attributes:
        commands: What the robot can do.
        margin: Clearance that every planned pose keeps (m). Smaller ones are tried where this finds nothing.
        least_margin: The smallest of these (m), in places that are narrow.
        last_margin: What is risked (m) to get out of a place where the robot cannot even turn round.
        preferred: Clearance that is kept where there is room (m).
        lookahead: How far along the path commands are searched (m).
        reach: How near to the path's point is there (m); at the path's end ``end_reach``.
        end_reach: How near to the end of the path is there (m).
        keep: Distance to ``points`` below which commands are not planned (m).
        points: (n, 2) what the robot's beams have hit, in its own frame (m).
    """

    commands: Commands
    margin: float = 0.2
    least_margin: float = 0.15
    last_margin: float = 0.12
    preferred: float = 0.4
    lookahead: float = LOOKAHEAD
    reach: float = REACH
    end_reach: float = END_REACH
    keep: float = 0.0
    points: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 2)), repr=False)
    _queue: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64), repr=False)
    _kept: float = field(default=math.inf, repr=False)  # clearance that the planned commands were meant to keep

    @classmethod
    def with_extra_room(cls, commands: Commands, extra: float) -> "PathFollower":
        """Return one that keeps ``extra`` more of every clearance than the default ones (m)."""
        rooms = {name: getattr(cls, name) + extra for name in ("margin", "least_margin", "last_margin", "preferred")}
        return cls(commands, **rooms)

    @property
    def planned(self) -> NDArray[np.int64]:
        """The commands that are still to come, (n,) indices."""
        return self._queue

    def clear(self) -> None:
        """Forget the commands that are still to come."""
        self._queue = np.empty(0, np.int64)

    def plan(self, path: NDArray[np.float64], pose: NDArray[np.float64], around: Surroundings) -> bool:
        """Search commands along ``path``; what was planned before stays where nothing is found, or if it still serves.

        Args:
            path: (n, 2) x, y (m), n >= 1, the end last.
            pose: (3,) x, y, theta of the robot.
            around: Its surroundings.

        Returns:
            Whether a sequence was found.
        """
        if len(self._queue) and self._leads_to(path, pose, around):
            return True
        attempts = [
            (self.margin, self.lookahead),
            (self.least_margin, self.lookahead),
            (self.least_margin, 2.0 * self.lookahead),  # past a place too narrow to end in
            (self.least_margin, 0.5 * self.lookahead),
        ]
        if not self.can_loiter(pose, around):
            attempts.append((self.last_margin, 0.5 * self.lookahead))
        for margin, lookahead in attempts:
            sequence = self._towards(path, pose, around, margin, lookahead)
            if len(sequence) and is_safe(self.points, self.commands, sequence, self.keep):
                self.follow(sequence, margin)
                return True
        return False

    def follow(self, sequence: NDArray[np.int64], kept: float = 0.0) -> None:
        """Plan a sequence (n,) of commands that is meant to keep a clearance (m)."""
        self._queue, self._kept = sequence, kept

    def _leads_to(self, path: NDArray[np.float64], pose: NDArray[np.float64], around: Surroundings) -> bool:
        """Whether the planned commands end where they would be planned to now, as they do while the robot turns."""
        index = lookahead_point(path, pose, around.gap, around.closed, around.frame, self.lookahead, self.margin)
        end = predict(pose, self.commands, self._queue)[-1]
        return math.dist(end[:2], path[index]) <= self.reach and self.is_clear(pose, around, len(self._queue))

    def _towards(
        self,
        path: NDArray[np.float64],
        pose: NDArray[np.float64],
        around: Surroundings,
        margin: float,
        lookahead: float,
    ) -> NDArray[np.int64]:
        index = lookahead_point(path, pose, around.gap, around.closed, around.frame, lookahead, margin)
        reach = self.end_reach if index == len(path) - 1 else self.reach
        x, y = path[index]
        return steer(around, pose, (float(x), float(y)), self.commands, margin, self.preferred, reach=reach)

    def is_clear(self, pose: NDArray[np.float64], around: Surroundings, horizon: int = 8) -> bool:
        """Return whether the next ``horizon`` planned commands keep clear, driven from ``pose``.

        They must keep the clearance that they were planned with, or the smaller one that the robot has already.
        """
        at = np.asarray(pose, np.float64)
        here = gap_at(around.gap, around.closed, around.frame, at[0], at[1])
        least = tightest(around.gap, around.closed, around.frame, at, self.commands.moves, self._queue[:horizon])
        return bool(least >= min(self._kept - TOLERANCE, max(here, 0.0) - 0.01))

    def next(self) -> int | None:
        """Take the next planned command; None if there is none."""
        if not len(self._queue):
            return None
        command = int(self._queue[0])
        self._queue = self._queue[1:]
        return command

    def can_loiter(self, pose: NDArray[np.float64], around: Surroundings) -> bool:
        """Return whether the robot has room to drive a circle where it is, keeping ``least_margin``."""
        at = np.asarray(pose, np.float64)
        turns = [k for k, (_, w) in enumerate(self.commands.velocities) if w != 0.0]
        return max(self._room(k, at, around) for k in turns) >= self.least_margin

    def _room(self, command: int, pose: NDArray[np.float64], around: Surroundings) -> float:
        velocity = self.commands.velocities[command]
        return float(loiter_gap(around.gap, around.closed, around.frame, pose, velocity))


@kernel
def path_is_blocked(
    path: NDArray[np.float64],
    position: NDArray[np.float64],
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
    frame: NDArray[np.float64],
    margin: float,
) -> bool:
    """The kernel of :func:`blocked_ahead`; gap and closed (rows, cols), frame (3,), position (2,) or longer."""
    nearest = _nearest_point(path, position)
    width, height = gap.shape[1] * frame[2], gap.shape[0] * frame[2]
    for i in range(nearest, path.shape[0]):
        x, y = path[i, 0], path[i, 1]
        inside = frame[0] <= x < frame[0] + width and frame[1] <= y < frame[1] + height
        if not inside or math.hypot(x - position[0], y - position[1]) <= _SHORTEST_LOOK:
            continue
        if gap_at(gap, closed, frame, x, y) < margin:
            return True
    return False


def blocked_ahead(path: NDArray[np.float64], pose: NDArray[np.float64], around: Surroundings, margin: float) -> bool:
    """Return whether what remains of a path comes nearer than ``margin`` to an obstacle or into a closed cell.

    Args:
        path: (n, 2) x, y (m), n >= 1.
        pose: (3,) x, y, theta of the robot; the path is looked at from its point nearest to the robot on, but not
            within 0.2 m of the robot, which may have to leave a place that is too narrow.
        around: The robot's surroundings; what of the path lies outside of them counts as free.
        margin: Least clearance (m).
    """
    at = np.asarray(pose, np.float64)
    return bool(path_is_blocked(path, at, around.gap, around.closed, around.frame, margin))


@kernel
def _predict(pose: NDArray[np.float64], moves: NDArray[np.float64], sequence: NDArray[np.int64]) -> NDArray[np.float64]:
    here = pose.copy()
    poses = np.empty((sequence.shape[0], 3))
    for i in range(sequence.shape[0]):
        move(here, moves[sequence[i]])
        poses[i] = here
    return poses


def predict(pose: NDArray[np.float64], commands: Commands, sequence: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the poses (n, 3) after each of a sequence (n,) of commands, headings not wrapped."""
    poses: NDArray[np.float64] = _predict(np.asarray(pose, np.float64), commands.moves, sequence)
    return poses
