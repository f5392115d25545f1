"""Driving an exploration robot to a place on the map that it believes in.

The driver reads the map and the pose from ``info`` and nothing else but the beams. What they have hit nearby lately
counts as occupied even where the map says otherwise: a thin leg that the map has a hand's breadth beside is where the
beams see it, not where older scans outvote them. It plans a path with A* on the inflated map, lets a
:class:`PathFollower` turn it into commands, and compares what is left of them with the hits themselves before every
single command (:mod:`lidarena.planning.grid.guard`).
"""

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.exploration.robot_interface import Robot
from lidarena.planning.driving.whereabouts import (
    Whereabouts,
    empty_whereabouts,
    find_way_back,
    has_no_way_back,
    is_caught,
    note_whereabouts,
)
from lidarena.planning.grid.connected import connected_cells, known_extent
from lidarena.planning.grid.frontiers import nearest_cell
from lidarena.planning.grid.grid_search import find_path
from lidarena.planning.grid.guard import GUARDED, carried, is_safe, nearby, turn_in_place, way_out
from lidarena.planning.grid.inflation import Inflation, clearance, inflate, open_start
from lidarena.planning.grid.path_following import PathFollower, blocked_ahead
from lidarena.planning.grid.steering import move
from lidarena.planning.grid.surroundings import Surroundings

_NEARBY = 1.2  # half the side of the window that is looked at before every command (m)
_NEAR_HITS = 0.6  # hits so near are remembered … (m)
_REMEMBERED = 2.0  # … for so long (s)
_LETHAL, _INFLATED = 0.22, 0.6  # paths keep off walls by the first, where they can by the second (m)
_SOFT = 0.2  # beyond the first, walls are kept off so much farther where there is room (m)
_CLOSER = 0.02  # commands may come so much nearer to walls than a path (m)
_ESCAPE = 0.6  # how far around a robot in the lethal zone cells are opened (m)


@dataclass(frozen=True)
class Terrain:
    """The known part of the map, prepared for planning.

    Attributes:
        occupancy: (rows, cols) the cropped map.
        cost: (rows, cols) of entering a cell, inf where blocked.
        reachable: (rows, cols) bool, cells that A* can reach from the robot.
        around: Clearances and where the crop lies.
        cell: [row, column] of the robot.
    """

    occupancy: NDArray[np.int8]
    cost: NDArray[np.float64]
    reachable: NDArray[np.bool_]
    around: Surroundings
    cell: tuple[int, int]


@dataclass
class Driver:
    """Keeps a goal and a path, and returns one action after the other.

    Attributes:
        robot: The robot.
        inflation: How far to keep off the walls when planning paths. Like every other distance from walls it is that of
            DA-SLAM's robot, and for another one larger by as much as it collides at a larger distance.
        clearance: How far paths keep off walls (m); None: as the robot is told to, or ``0.22`` for DA-SLAM's.
        arrival: Distance to the goal that counts as there (m).
    """

    robot: Robot
    clearance: float | None = None
    inflation: Inflation = field(init=False)
    arrival: float = 0.3
    pose: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    goal: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        """Start with nothing planned."""
        self._extra = self.robot.extra_room
        told = self.robot.spec.clearance if self.clearance is None else self.clearance
        lethal = _LETHAL + self._extra if told is None else told
        self.inflation = Inflation(lethal_radius=lethal, radius=max(_INFLATED + self._extra, lethal + _SOFT))
        self.reset()

    def reset(self) -> None:
        """Forget the goal and everything planned."""
        self._follower = PathFollower.with_extra_room(self.robot.commands, self._extra)
        self._follower.keep = self.robot.least_distance
        if self.inflation.lethal_radius < _LETHAL + self._extra:  # ways are narrower than drivers are made for
            self._follower.margin = min(self._follower.margin, self.inflation.lethal_radius)
            closest = max(self.inflation.lethal_radius - _CLOSER, self.robot.spec.bumper)
            self._follower.least_margin = min(self._follower.least_margin, closest)
        self.stop()
        self._info: Mapping[str, Any] = {}
        self._observation: Any = None
        self._hits: deque[NDArray[np.float64]] = deque(maxlen=max(1, round(_REMEMBERED / self.robot.period)))
        self._reckoned, self._given = np.zeros(3), -1  # where the commands should have taken it, as ``_hits`` see it
        self._scanned, self._scan_sum, self._turning = np.zeros(3), math.nan, -1
        self._been: Whereabouts | None = None

    def stop(self) -> None:
        """Give up the goal."""
        self.goal = None
        self._path = np.empty((0, 2))
        self._follower.clear()

    def sense(self, observation: Any, info: Mapping[str, Any]) -> None:
        """Take in the environment's newest observation and info."""
        self._observation, self._info = self.robot.beams_in(observation, info), info
        self.pose = np.array(info["pose"], dtype=np.float64)
        if self._given >= 0:
            move(self._reckoned, self.robot.commands.moves[self._given])
            self._given = -1
        total = self.robot.sum_of_beams(self._observation)
        is_new = total != self._scan_sum
        if is_new:
            self._scan_sum, self._scanned = total, self._reckoned.copy()
            self._hits.append(self.robot.hits(self._observation, self._reckoned, _NEAR_HITS + self._extra))
        else:
            self._hits.append(np.empty((0, 2)))  # a slow lidar's scan of before
        self._note_whereabouts(is_new)
        self._around = self._nearby()
        self._is_clear = self._follower.is_clear(self.pose, self._around)
        self._follower.points = self._points_around()

    def _note_whereabouts(self, is_new: bool) -> None:
        """Remember where the robot is and what it sees; nothing without beams."""
        scan = self.robot.ranges(self._observation)
        if self._been is None:
            self._been = empty_whereabouts(1, len(scan))
        all_around = self.robot.sees_what_is_near(self._observation)
        plans = len(self._follower.planned) > 0
        note_whereabouts(0, self._reckoned, scan, is_new, plans, all_around, self._been)

    def _points_around(self) -> NDArray[np.float64]:
        """What the robot must keep clear of, (n, 2) in its own frame; see ``driving.survey.points_around``."""
        seen = carried(self.robot.hits(self._observation, np.zeros(3), GUARDED), np.zeros(3), self._scanned)
        points = nearby(np.concatenate([seen, *list(self._hits)[:-1]]), self._reckoned)
        if self.robot.sees_what_is_near(self._observation):
            return np.asarray(points)
        closed = self._around.points(np.argwhere(self._occupied))
        return np.concatenate([points, nearby(closed, self.pose)])

    def _nearby(self) -> Surroundings:
        """Clearances in a window around the robot, from the newest map."""
        occupancy, resolution = self._info["map"], float(self._info["resolution"])
        x, y = (float(value) for value in self._info["origin"])
        row, col = int((self.pose[1] - y) / resolution), int((self.pose[0] - x) / resolution)
        half = math.ceil((_NEARBY + self._extra) / resolution)
        rows, cols = _overlap(row, half, occupancy.shape[0]), _overlap(col, half, occupancy.shape[1])
        origin = (x + cols.start * resolution, y + rows.start * resolution)
        marked = self._with_hits(occupancy[rows, cols], origin, resolution)
        self._occupied = marked >= self.inflation.occupied_from
        return self._surroundings(marked, origin)

    def _with_hits(
        self, occupancy: NDArray[np.int8], origin: tuple[float, float], resolution: float
    ) -> NDArray[np.int8]:
        """A copy of a part of the map in which what the beams have hit lately is occupied."""
        marked = np.array(occupancy, dtype=np.int8, order="C")
        hits = carried(np.concatenate(self._hits), self._reckoned, self.pose)
        cells = np.floor((hits - origin) / resolution).astype(np.int64)
        inside = ((cells >= 0) & (cells < (marked.shape[1], marked.shape[0]))).all(axis=1)
        marked[cells[inside, 1], cells[inside, 0]] = 100
        return marked

    def _surroundings(self, occupancy: NDArray[np.int8], origin: tuple[float, float]) -> Surroundings:
        resolution = float(self._info["resolution"])
        gap = clearance(occupancy, resolution, self.inflation.occupied_from, self.inflation.radius + resolution)
        closed = (occupancy < 0) | (occupancy >= self.inflation.occupied_from)
        return Surroundings(gap, closed, resolution, origin)

    def survey(self) -> Terrain | None:
        """Prepare the newest map for planning; None as long as nothing is known."""
        occupancy, resolution = self._info["map"], float(self._info["resolution"])
        top, bottom, left, right = known_extent(occupancy)
        if not bottom:
            return None
        # one more line on either side for the frontiers
        rows, cols = slice(max(top - 1, 0), bottom + 1), slice(max(left - 1, 0), right + 1)
        x, y = (float(value) for value in self._info["origin"])
        origin = (x + cols.start * resolution, y + rows.start * resolution)
        crop = self._with_hits(occupancy[rows, cols], origin, resolution)
        around = self._surroundings(crop, origin)
        cell = around.cell(self.pose[0], self.pose[1])
        cost = inflate(crop, resolution, self.inflation, around.gap)
        open_start(cost, crop, around.gap, cell, math.ceil((_ESCAPE + self._extra) / resolution), self.inflation)
        return Terrain(crop, cost, _reachable(cost, cell), around, cell)

    def go(self, goal: tuple[float, float], terrain: Terrain) -> bool:
        """Set out for a goal.

        Args:
            goal: World x, y (m).
            terrain: The newest :meth:`survey`.

        Returns:
            Whether there is a path and a first sequence of commands along it; if not, nothing has changed.
        """
        same = self.goal is not None and math.dist(goal, self.goal) < terrain.around.resolution
        path = self._path if same and not self._is_path_blocked() else self._find(goal, terrain)
        if not len(path):
            return False
        if math.dist(goal, self.pose[:2]) <= self.arrival:
            self._follower.clear()  # it is there; turning lets it look around
        elif not self._follower.plan(path, self.pose, terrain.around):
            return False
        self.goal, self._path = goal, path
        return True

    def _find(self, goal: tuple[float, float], terrain: Terrain) -> NDArray[np.float64]:
        return terrain.around.points(find_path(terrain.cost, terrain.cell, terrain.around.cell(*goal)))

    def _is_path_blocked(self) -> bool:
        margin = self._follower.least_margin
        return len(self._path) == 0 or blocked_ahead(self._path, self.pose, self._around, margin)

    @property
    def path(self) -> NDArray[np.float64]:
        """The path that is followed, (n, 2) x, y (m); (0, 2) if there is none."""
        return self._path

    @property
    def arrived(self) -> bool:
        """Whether the robot is at its goal."""
        return self.goal is not None and math.dist(self.goal, self.pose[:2]) <= self.arrival

    @property
    def remaining(self) -> float:
        """What remains of the path, from its point nearest to the robot on (m)."""
        if not len(self._path):
            return 0.0
        nearest = int(np.argmin(np.hypot(*(self._path - self.pose[:2]).T)))
        return float(np.hypot(*np.diff(self._path[nearest:], axis=0).T).sum())

    @property
    def must_plan(self) -> bool:
        """Whether commands have run out before the goal, or the newest map shows an obstacle on the way."""
        if self.goal is None or self.arrived:
            return False
        if not len(self._follower.planned):
            return True
        return not self._is_clear or self._is_path_blocked()

    @property
    def is_cornered(self) -> bool:
        """Whether the robot has no room to turn round where it is; nothing can be said of a goal then."""
        return not self._follower.can_loiter(self.pose, self._around)

    @property
    def is_caught(self) -> bool:
        """Whether the robot has stayed near one place for long."""
        return self._been is not None and bool(is_caught(0, self.robot.period, self._been))

    @property
    def retreats(self) -> bool:
        """Whether the robot is on its way back to where it came from."""
        return self._been is not None and bool(self._been.retreats[0]) and len(self._follower.planned) > 0

    def is_cut_off(self, terrain: Terrain) -> bool:
        """Whether the newest survey shows no way to where the robot came from."""
        if self._been is None:
            return False
        frame = terrain.around.frame
        return bool(has_no_way_back(0, self._reckoned, self.pose, terrain.reachable, frame, self._been))

    def retreat(self) -> bool:
        """Give up the goal and drive back to where the robot came from; whether a way is found."""
        if self._been is None:
            return False
        follower, robot = self._follower, self.robot
        angles, longest = robot.angles(self._observation), robot.sight
        found = find_way_back(
            0, self._reckoned, follower.points, angles, longest, robot.commands, follower.keep, self._been
        )
        if not len(found):
            return False
        self.stop()
        follower.follow(found)
        self._been.retreats[0] = True
        return True

    def action(self) -> Any:
        """Return the next action: the next planned command if beams say that it is safe, else a turn or the way out."""
        follower, commands = self._follower, self.robot.commands
        points, keep, room = follower.points, follower.keep, follower.margin
        if len(follower.planned) and not is_safe(points, commands, follower.planned, keep):
            follower.clear()
        if not len(follower.planned):
            self._turning = turn_in_place(points, commands, self._turning, keep, room)
            if self._turning >= 0:
                return self._give(self._turning)
            follower.follow(way_out(points, commands, keep))
        self._turning = -1
        command = follower.next()
        return self._give(turn_in_place(points, commands, -1, 0.0, room) if command is None else command)

    def _give(self, command: int) -> Any:
        self._given = int(command)
        return self.robot.action(self._given)


def _overlap(centre: int, half: int, size: int) -> slice:
    """The part of ``centre - half .. centre + half`` inside 0 .. size - 1, at least one cell."""
    first = min(max(centre - half, 0), size - 1)
    return slice(first, max(min(centre + half + 1, size), first + 1))


def _reachable(cost: NDArray[np.float64], cell: tuple[int, int]) -> NDArray[np.bool_]:
    """The cells connected with ``cell``, or with the passable cell nearest to it."""
    passable = np.isfinite(cost)
    row, col = nearest_cell(passable, float(cell[0]), float(cell[1]))
    if row < 0:
        return passable
    # without corner cutting, whatever 8 neighbours connect 4 neighbours connect too
    connected: NDArray[np.bool_] = connected_cells(passable, row, col)
    return connected
