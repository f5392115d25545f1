"""What drivers of many worlds know and plan, as arrays that lead with (worlds,)."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.driving.whereabouts import Whereabouts, empty_whereabouts
from lidarena.planning.grid.steering import Commands

NEARBY, NEAR_HITS, REMEMBERED = 1.2, 0.6, 2.0
"""Half the side of the window that is looked at before every command [m]; hits so near [m] are kept so long [s]."""
LETHAL, INFLATED, ESCAPE, ARRIVAL = 0.22, 0.6, 0.6, 0.3
"""Paths keep off walls by the first, where they can by the second; how far around a robot in the lethal zone cells are
opened; distance to the goal that counts as there [m]."""
_MARGINS = (0.2, 0.15, 0.12, 0.4)
_LONGEST_PATH, _LONGEST_QUEUE = 4096, 1024


class LidarView(NamedTuple):
    """Where a lidar looks.

    Attributes:
        angles: (beams,) [rad].
        all_around: Whether nothing near is hidden between two beams or outside of the field of view.
    """

    angles: NDArray[np.float64]
    all_around: bool


class DriverSettings(NamedTuple):
    """How robots drive.

    Attributes:
        commands: What a robot can do.
        angles: (beams,) of its lidar [rad].
        max_range: Of its lidar [m].
        extra: How much more room than DA-SLAM's robot it needs [m].
        keep: Commands that lead nearer than this to what a beam hit, and nearer than before, are not given [m].
        all_around: Whether its beams see all that is near.
        margins: (4,) clearance that planned poses keep; that in narrow places; that to get out of a place where the
            robot cannot turn round; that which is kept where there is room [m].
        resolution: Side of a map cell [m].
    """

    commands: Commands
    angles: NDArray[np.float64]
    max_range: float
    extra: float
    keep: float
    all_around: bool
    margins: NDArray[np.float64]
    resolution: float


class Perceptions(NamedTuple):
    """What the drivers of W worlds are told.

    Attributes:
        maps: (W, rows, columns) int8, -1 unknown, 0 free .. 100 occupied.
        origin: (W, 2) x, y of the maps' lower-left corners [m].
        poses: (W, 3) believed.
        scans: (W, beams) float32 ranges [m].
    """

    maps: NDArray[np.int8]
    origin: NDArray[np.float64]
    poses: NDArray[np.float64]
    scans: NDArray[np.float32]


class KnownGround(NamedTuple):
    """Grids of W worlds, each in a row of its own of which ``extent`` says how much is used.

    Attributes:
        occupancy: (W, cells) int8 with the hits of late.
        gap: (W, cells) float32 clearances [m].
        closed: (W, cells) bool, cells where no robot's centre must be.
        cost: (W, cells) of entering a cell, inf where blocked.
        reachable: (W, cells) bool, cells that can be reached from the robot.
        way: (W, cells) length of the way from the robot to each cell, inf where there is none [m].
        extent: (W, 4) first row and column in the map, rows, columns; no rows: nothing is known.
        frame: (W, 3) x, y of the corner, side of a cell [m].
        cell: (W, 2) row and column of the robot in it.
    """

    occupancy: NDArray[np.int8]
    gap: NDArray[np.float32]
    closed: NDArray[np.bool_]
    cost: NDArray[np.float64]
    reachable: NDArray[np.bool_]
    way: NDArray[np.float64]
    extent: NDArray[np.int64]
    frame: NDArray[np.float64]
    cell: NDArray[np.int64]


class Drive(NamedTuple):
    """What W drivers remember and plan.

    Attributes:
        reckoned: (W, 3) where the commands have taken the robot since it began, if all went as it should.
        given: (W,) the command that it executes, -1 for none.
        scanned: (W, 3) where it had been taken when the newest scan was made.
        scan_sum: (W,) sum of that scan's ranges; a slow lidar repeats its last one.
        hits: (W, H, beams, 2) where beams hit something nearby in the last H steps, in turn; about ``reckoned`` [m].
        hit_counts: (W, H) how many.
        newest: (W,) which of the H was written last.
        near: The window around the robot.
        ground: All that is known, as of the last survey.
        goal: (W, 2) [m].
        has_goal: (W,) bool.
        path: (W, points, 2) [m].
        path_points: (W,) how many are used.
        queue: (W, commands) that are planned.
        queue_span: (W, 2) the first that is to come, and the end.
        kept: (W,) clearance that they were meant to keep [m].
        turning: (W,) the command with which the robot loiters, -1 for none.
        been: Where the robot has been of late.
    """

    reckoned: NDArray[np.float64]
    given: NDArray[np.int64]
    scanned: NDArray[np.float64]
    scan_sum: NDArray[np.float64]
    hits: NDArray[np.float64]
    hit_counts: NDArray[np.int64]
    newest: NDArray[np.int64]
    near: KnownGround
    ground: KnownGround
    goal: NDArray[np.float64]
    has_goal: NDArray[np.bool_]
    path: NDArray[np.float64]
    path_points: NDArray[np.int64]
    queue: NDArray[np.int64]
    queue_span: NDArray[np.int64]
    kept: NDArray[np.float64]
    turning: NDArray[np.int64]
    been: Whereabouts


def make_settings(
    commands: Commands, lidar: LidarView, max_range: float, extra: float, keep: float, resolution: float
) -> DriverSettings:
    """Return the settings of a robot that needs ``extra`` more room than DA-SLAM's; see ``DriverSettings``."""
    beams = np.ascontiguousarray(lidar.angles, np.float64)
    margins = np.array(_MARGINS) + extra
    return DriverSettings(commands, beams, float(max_range), extra, keep, lidar.all_around, margins, resolution)


def empty_drive(worlds: int, rows: int, columns: int, settings: DriverSettings) -> Drive:
    """Allocate drivers for maps of so many cells."""
    remembered = max(1, round(REMEMBERED / settings.commands.period))
    beams = len(settings.angles)
    side = 2 * math.ceil((NEARBY + settings.extra) / settings.resolution) + 1
    return Drive(
        np.zeros((worlds, 3)),
        np.full(worlds, -1, np.int64),
        np.zeros((worlds, 3)),
        np.full(worlds, np.nan),
        np.zeros((worlds, remembered, beams, 2)),
        np.zeros((worlds, remembered), np.int64),
        np.zeros(worlds, np.int64),
        _empty_ground(worlds, side * side),
        _empty_ground(worlds, rows * columns),
        np.zeros((worlds, 2)),
        np.zeros(worlds, np.bool_),
        np.zeros((worlds, _LONGEST_PATH, 2)),
        np.zeros(worlds, np.int64),
        np.zeros((worlds, _LONGEST_QUEUE), np.int64),
        np.zeros((worlds, 2), np.int64),
        np.full(worlds, np.inf),
        np.full(worlds, -1, np.int64),
        empty_whereabouts(worlds, beams),
    )


def _empty_ground(worlds: int, cells: int) -> KnownGround:
    return KnownGround(
        np.zeros((worlds, cells), np.int8),
        np.zeros((worlds, cells), np.float32),
        np.zeros((worlds, cells), np.bool_),
        np.zeros((worlds, cells)),
        np.zeros((worlds, cells), np.bool_),
        np.zeros((worlds, cells)),
        np.zeros((worlds, 4), np.int64),
        np.zeros((worlds, 3)),
        np.zeros((worlds, 2), np.int64),
    )


def forget(drive: Drive, world: int) -> None:
    """Begin anew in one world."""
    drive.reckoned[world] = drive.scanned[world] = 0.0
    drive.given[world], drive.scan_sum[world] = -1, np.nan
    drive.hit_counts[world] = drive.newest[world] = 0
    drive.has_goal[world] = False
    drive.path_points[world], drive.queue_span[world] = 0, 0
    drive.kept[world], drive.turning[world] = np.inf, -1
    drive.ground.extent[world] = 0
    for array in drive.been:
        array[world] = 0
