"""The way out of a pocket by which a robot has come in, on what its own beams have seen from there.

A map that is drawn from believed poses smears walls by some centimetres, and a passage that a robot has just fitted
through is closed on it. Where the commands have taken the robot is far surer over a minute than where it believes to
be. So views, whole scans with the places that they were made from, are remembered in that frame, the newest of every
place. Together they are a sharp map of what is near, on which what no beam has passed counts as a wall: where the robot
is sent, nothing can be hidden. Wherever it has driven in, it has seen the ground that it needs to turn and drive out.
"""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.planning.grid.guard import carried, is_safe
from lidarena.planning.grid.inflation import squared_distances
from lidarena.planning.grid.steering import WEIGHT, WINDOW, Commands, search_commands
from lidarena.planning.grid.surroundings import gap_at
from lidarena.planning.grid.way_lengths import way_lengths

VIEWS = 64
"""Views that are remembered."""
SPACING = 0.25
"""Of those from one square so wide only the newest is [m]."""
_TURNED = 0.8  # views in directions so far apart are of two places, where the lidar does not see all around [rad]
_SIDE = 0.03  # of the cells of the sharp map [m]
_HALF = 2.4  # half the side of it [m]
_FARTHEST = 3.5  # views from places farther away from the robot, or what they show farther away, are left out [m]
_BINS = 1440  # directions in which a view is looked up
_REACH = 0.8  # clearances up to this are told apart [m]
_AWAY, _NEAR_EDGE = 1.0, 0.3  # how far the way back must lead at least; how far from the map's edge it must end [m]
_PLACES = 6  # ends of a way back that are tried, at most
_ROOMY = 0.5  # more clearance than this makes no end better [m]
_SPARED = np.array([0.08, 0.05, 0.02, 0.0])  # clearance beyond the least, one after the other, until there is a way [m]
_PREFERRED, _THERE = 0.2, 0.2  # clearance beyond the least that costs nothing extra; how near to the end is there [m]
_MOST_STATES = 20000.0  # that are looked at for one end


@kernel
def note_view(
    places: NDArray[np.float64],
    ranges: NDArray[np.float32],
    made_at: NDArray[np.int64],
    count: int,
    place: NDArray[np.float64],
    scan: NDArray[np.float32],
    now: int,
    all_around: bool,
) -> int:
    """Remember a scan, in place of that from the same place, or else of the oldest.

    Args:
        places: (K, 3) from where scans were made [m, m, rad].
        ranges: (K, beams) the scans [m].
        made_at: (K,) at which steps.
        count: How many are remembered.
        place: (3,) where this one was made.
        scan: (beams,) [m].
        now: Step.
        all_around: Whether the lidar sees all around.

    Returns:
        How many are remembered now.
    """
    slot = -1
    for k in range(count):
        same = math.floor(places[k, 0] / SPACING) == math.floor(place[0] / SPACING)
        same = same and math.floor(places[k, 1] / SPACING) == math.floor(place[1] / SPACING)
        turned = abs((places[k, 2] - place[2] + math.pi) % (2.0 * math.pi) - math.pi)
        if same and (all_around or turned < _TURNED):
            slot = k
    if slot < 0 and count < len(places):
        slot, count = count, count + 1
    elif slot < 0:
        slot = int(np.argmin(made_at))
    places[slot], ranges[slot], made_at[slot] = place, scan, now
    return count


@leaf
def _mark_seen(
    seen: NDArray[np.bool_],
    view: NDArray[np.float64],
    scan: NDArray[np.float32],
    beside: NDArray[np.int64],
    longest: float,
) -> None:
    """Mark the cells (side, side) that a view (3,) in the robot's frame shows free: the beams beside pass them."""
    side = seen.shape[0]
    for r in range(side):
        for c in range(side):
            if seen[r, c]:
                continue
            x, y = (c + 0.5) * _SIDE - _HALF - view[0], (r + 0.5) * _SIDE - _HALF - view[1]
            away = math.hypot(x, y)
            if away >= longest:
                continue
            k = int((math.atan2(y, x) - view[2]) % (2.0 * math.pi) / (2.0 * math.pi) * _BINS) % _BINS
            first, second = beside[k, 0], beside[k, 1]
            seen[r, c] = first >= 0 and away < scan[first] and away < scan[second]


@kernel
def _mark_hits(
    occupancy: NDArray[np.int8],
    view: NDArray[np.float64],
    scan: NDArray[np.float32],
    angles: NDArray[np.float64],
    longest: float,
) -> None:
    """Mark the cells (side, side) in which beams of a view (3,) in the robot's frame have hit something."""
    side = occupancy.shape[0]
    for b in range(len(angles)):
        if 0.0 < scan[b] < longest:
            angle = view[2] + angles[b]
            c = math.floor((view[0] + scan[b] * math.cos(angle) + _HALF) / _SIDE)
            r = math.floor((view[1] + scan[b] * math.sin(angle) + _HALF) / _SIDE)
            if 0 <= r < side and 0 <= c < side:
                occupancy[r, c] = 100


@kernel
def _beams_beside(angles: NDArray[np.float64]) -> NDArray[np.int64]:
    """The beams (bins, 2) on either side of each direction; -1 where the next is more than two degrees off."""
    beside = np.full((_BINS, 2), -1, np.int64)
    for k in range(_BINS):
        direction, left, right = (k + 0.5) * 2.0 * math.pi / _BINS, math.inf, math.inf
        for b in range(len(angles)):
            ahead = (angles[b] - direction) % (2.0 * math.pi)
            behind = (direction - angles[b]) % (2.0 * math.pi)
            if ahead < left:
                left, beside[k, 0] = ahead, b
            if behind < right:
                right, beside[k, 1] = behind, b
        if max(left, right) > math.radians(2.0):
            beside[k] = -1
    return beside


@kernel
def sharp_map(
    places: NDArray[np.float64],
    ranges: NDArray[np.float32],
    angles: NDArray[np.float64],
    longest: float,
    here: NDArray[np.float64],
) -> NDArray[np.float32]:
    """Clearances (side, side) around the robot, in its frame, by what views have seen [m]; what none has is a wall.

    Args:
        places: (n, 3) from where scans were made.
        ranges: (n, beams) the scans [m].
        angles: (beams,) [rad].
        longest: Range of the lidar [m].
        here: (3,) the robot's pose among the places.
    """
    side = 2 * round(_HALF / _SIDE)
    seen, occupancy = np.zeros((side, side), np.bool_), np.zeros((side, side), np.int8)
    beside, sight = _beams_beside(angles), min(longest, _FARTHEST)
    own = carried(places[:, :2].copy(), here, np.zeros(3))
    for k in range(len(places)):
        if math.hypot(own[k, 0], own[k, 1]) >= _FARTHEST:
            continue
        view = np.array([own[k, 0], own[k, 1], places[k, 2] - here[2]])
        _mark_seen(seen, view, ranges[k], beside, sight)
        _mark_hits(occupancy, view, ranges[k], angles, sight)
    squares = squared_distances(np.where(seen, occupancy, np.int8(100)), 50, math.ceil(_REACH / _SIDE))
    gap = np.empty((side, side), np.float32)
    for r in range(side):
        for c in range(side):
            gap[r, c] = max((np.sqrt(np.float32(squares[r, c])) - np.float32(0.5)) * np.float32(_SIDE), np.float32(0.0))
    return gap


@kernel
def is_cut_off(
    places: NDArray[np.float64],
    here: NDArray[np.float64],
    pose: NDArray[np.float64],
    reachable: NDArray[np.bool_],
    frame: NDArray[np.float64],
    beyond: float,
) -> bool:
    """Whether a map shows no way to any of the places that a robot has come from.

    Args:
        places: (n, 3) which are those.
        here: (3,) the robot's pose among them.
        pose: (3,) its pose on the map.
        reachable: (rows, cols) cells of the map to which there is a way.
        frame: (3,) x, y of its corner, side of a cell [m].
        beyond: Places nearer than this do not count [m].
    """
    on_map, any_left = carried(places[:, :2].copy(), here, pose), False
    for k in range(len(on_map)):
        if math.hypot(on_map[k, 0] - pose[0], on_map[k, 1] - pose[1]) < beyond:
            continue
        any_left = True
        r, c = math.floor((on_map[k, 1] - frame[1]) / frame[2]), math.floor((on_map[k, 0] - frame[0]) / frame[2])
        if 0 <= r < reachable.shape[0] and 0 <= c < reachable.shape[1] and reachable[r, c]:
            return False
    return any_left


@kernel
def _ends(gap: NDArray[np.float32], own: NDArray[np.float64], keep: float) -> NDArray[np.float64]:
    """The best of the places (n, 2) where a way back could end, (m, 2): not far, and with room."""
    side = gap.shape[0]
    passable = gap >= np.float32(keep)
    middle = side // 2
    passable[middle - 2 : middle + 2, middle - 2 : middle + 2] = True  # the robot's own place
    lengths = way_lengths(passable, middle, middle)
    costs = np.full(len(own), np.inf)
    for k in range(len(own)):
        if max(abs(own[k, 0]), abs(own[k, 1])) >= _HALF - _NEAR_EDGE:
            continue
        r, c = math.floor((own[k, 1] + _HALF) / _SIDE), math.floor((own[k, 0] + _HALF) / _SIDE)
        if _AWAY <= lengths[r, c] * _SIDE < np.inf:
            costs[k] = lengths[r, c] * _SIDE - 2.0 * min(np.float64(gap[r, c]), _ROOMY)
    order = np.argsort(costs, kind="mergesort")
    count = min(int((costs < np.inf).sum()), _PLACES)
    return own[order[:count]].copy()


@kernel
def way_back(
    places: NDArray[np.float64],
    ranges: NDArray[np.float32],
    left: NDArray[np.bool_],
    angles: NDArray[np.float64],
    longest: float,
    here: NDArray[np.float64],
    points: NDArray[np.float64],
    commands: Commands,
    keep: float,
) -> NDArray[np.int64]:
    """The commands (n,) that lead to a place where the robot has been, where it can turn; (0,) if none are found.

    Args:
        places: (n, 3) from where scans were made.
        ranges: (n, beams) the scans [m].
        left: (n,) from which of the places the robot had come before it was caught.
        angles: (beams,) [rad].
        longest: Range of the lidar [m].
        here: (3,) the robot's pose among the places.
        points: (m, 2) that beams have hit lately, in the robot's own frame [m].
        commands: What the robot can do.
        keep: Least distance to what beams have hit [m].
    """
    gap = sharp_map(places, ranges, angles, longest, here)
    closed, frame, start = np.zeros(gap.shape, np.bool_), np.array([-_HALF, -_HALF, _SIDE]), np.zeros(3)
    own = carried(places[left][:, :2].copy(), here, start)
    room = gap_at(gap, closed, frame, 0.0, 0.0)
    limits = np.array([_THERE, WINDOW, _MOST_STATES])
    ends = _ends(gap, own, keep)
    for spared in _SPARED:
        least = min(keep + spared, room - 0.005)
        margins = np.array([least, keep + _PREFERRED, WEIGHT])
        for k in range(len(ends)):
            found = search_commands(gap, closed, frame, start, ends[k], commands, margins, limits)
            if len(found) > 0 and is_safe(points, commands, found, keep):
                return found
    return np.empty(0, np.int64)
