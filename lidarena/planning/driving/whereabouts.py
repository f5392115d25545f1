"""Where robots have been of late and what they saw there: who is caught drives back to where it came from."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel
from lidarena.planning.grid.retrace import VIEWS, is_cut_off, note_view, way_back
from lidarena.planning.grid.steering import Commands

FRESH = 120.0
"""Older views are not used [s]."""
CAUGHT, STRAYED = 40.0, 1.0
"""Who has not come so far [m] for so long [s] is caught: two turns on the spot take about as long."""
_MOVED = 0.5  # who has driven so far of a way back is no longer where it was caught [m]


class Whereabouts(NamedTuple):
    """Where W robots have been of late, and what they saw from there, about where the commands have taken them.

    Attributes:
        places: (W, K, 3) from where scans were made.
        ranges: (W, K, beams) float32 the scans [m].
        made_at: (W, K) at which steps.
        number: (W,) how many.
        now: (W,) steps since the beginning.
        anchor: (W, 2) where the robot has stayed near [m].
        anchored_at: (W,) since which step.
        retreats: (W,) bool, whether the planned commands lead back to where it came from.
    """

    places: NDArray[np.float64]
    ranges: NDArray[np.float32]
    made_at: NDArray[np.int64]
    number: NDArray[np.int64]
    now: NDArray[np.int64]
    anchor: NDArray[np.float64]
    anchored_at: NDArray[np.int64]
    retreats: NDArray[np.bool_]


def empty_whereabouts(worlds: int, beams: int) -> Whereabouts:
    """Allocate memory of where robots with so many beams have been."""
    return Whereabouts(
        np.zeros((worlds, VIEWS, 3)),
        np.zeros((worlds, VIEWS, beams), np.float32),
        np.zeros((worlds, VIEWS), np.int64),
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.int64),
        np.zeros((worlds, 2)),
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.bool_),
    )


@kernel
def note_whereabouts(
    w: int,
    here: NDArray[np.float64],
    scan: NDArray[np.float32],
    is_new: bool,
    drives_on: bool,
    all_around: bool,
    been: Whereabouts,
) -> None:
    """Note where a robot is now, and what it sees from there.

    Args:
        w: World.
        here: (3,) where the commands have taken it.
        scan: (beams,) [m].
        is_new: Whether the scan was made here.
        drives_on: Whether commands are planned.
        all_around: Whether the lidar sees all around.
        been: Of all worlds.
    """
    been.now[w] += 1
    if is_new:
        been.number[w] = note_view(
            been.places[w], been.ranges[w], been.made_at[w], been.number[w], here, scan, been.now[w], all_around
        )
    away = math.hypot(here[0] - been.anchor[w, 0], here[1] - been.anchor[w, 1])
    has_retreated = been.retreats[w] and not drives_on
    if away > STRAYED or (has_retreated and away > _MOVED):
        been.anchor[w, 0], been.anchor[w, 1], been.anchored_at[w] = here[0], here[1], been.now[w]
    if not drives_on:
        been.retreats[w] = False


@kernel
def is_caught(w: int, period: float, been: Whereabouts) -> bool:
    """Whether a robot has stayed near one place for long."""
    return bool((been.now[w] - been.anchored_at[w]) * period >= CAUGHT)


@kernel
def has_no_way_back(
    w: int,
    here: NDArray[np.float64],
    pose: NDArray[np.float64],
    reachable: NDArray[np.bool_],
    frame: NDArray[np.float64],
    been: Whereabouts,
) -> bool:
    """Whether the map shows no way to where a robot came from; see ``retrace.is_cut_off``."""
    left = np.flatnonzero(been.made_at[w, : been.number[w]] < been.anchored_at[w])
    return bool(is_cut_off(been.places[w][left], here, pose, reachable, frame, STRAYED))


@kernel
def find_way_back(
    w: int,
    here: NDArray[np.float64],
    points: NDArray[np.float64],
    angles: NDArray[np.float64],
    longest: float,
    commands: Commands,
    keep: float,
    been: Whereabouts,
) -> NDArray[np.int64]:
    """The commands (n,) that take a robot out of where it is caught, (0,) if none are found; see ``retrace.way_back``.

    Args:
        w: World.
        here: (3,) where the commands have taken it.
        points: (n, 2) that beams have hit lately, in its frame [m].
        angles: (beams,) of the lidar [rad].
        longest: Its range [m].
        commands: What the robot can do.
        keep: Least distance to what beams have hit [m].
        been: Of all worlds.
    """
    made_at = been.made_at[w, : been.number[w]]
    fresh = np.flatnonzero((been.now[w] - made_at) * commands.period <= FRESH)
    left = made_at[fresh] < been.anchored_at[w]
    if not left.any():
        return np.empty(0, np.int64)
    return way_back(been.places[w][fresh], been.ranges[w][fresh], left, angles, longest, here, points, commands, keep)
