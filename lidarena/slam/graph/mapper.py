"""A mapper that a robot's own program can call at each scan."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import EstimatorError
from lidarena.base.keyword_checks import check_range
from lidarena.slam.graph.adjustment import Compared, adjusted, torn_places
from lidarena.slam.graph.back_end import BackEnd
from lidarena.slam.graph.final_matching import match_with_nodes
from lidarena.slam.graph.front_end import FrontEnd, FrontEndParameters
from lidarena.slam.graph.surface_points import BeamFan
from lidarena.slam.planar import between, compose, inverse, wrapped

Floats = NDArray[np.float64]

_CONTRADICTED = 0.3
"""A loop from which the finished map is farther away [m, rad] was not kept."""
_UNLIKE, _SOME = 0.3, 0.02
"""Scans of which a smaller share fits are doubtful; one of fifty are too many."""
_MANY = 0.2
"""Share of the loops that may be wrong: places that look alike."""


@dataclass(frozen=True)
class MapParameters:
    """Settings of mapping by a graph of poses; the defaults serve robots in buildings.

    Attributes:
        front_end: How scans are matched.
        visits: Keyframes of places that were visited so often before are dropped from the graph, which so stops
            growing once a building is known; None keeps all.

    Raises:
        ConfigError: A number of visits below 1.
    """

    front_end: FrontEndParameters = field(default_factory=FrontEndParameters)
    visits: int | None = 2

    def __post_init__(self) -> None:
        if self.visits is not None:
            check_range("visits", self.visits, 1, 1000, whole=True)


@dataclass(frozen=True)
class Loop:
    """A place that the robot came back to.

    Attributes:
        from_scan: The later scan.
        to_scan: The earlier one.
        transform: (3,) pose of the later seen from the earlier, as their surfaces fit.
        residual: How far the finished map disagrees [m].
        kept: Whether the map was made with it.
    """

    from_scan: int
    to_scan: int
    transform: Floats
    residual: float
    kept: bool


@dataclass(frozen=True)
class PoseGraph:
    """Poses and what was measured between them.

    Attributes:
        nodes: (K, 3) poses of the laser.
        scans: (K,) which scans they are of.
        pairs: (E, 2) nodes from and to.
        motions: (E, 3) pose of the second seen from the first.
        information: (E, 3, 3) inverse covariances.
    """

    nodes: Floats
    scans: NDArray[np.int64]
    pairs: NDArray[np.int64]
    motions: Floats
    information: Floats


@dataclass(frozen=True)
class MapResult:
    """What a mapper made of everything that it was given.

    Attributes:
        poses: (S, 3) of the robot at every scan.
        loops: The loops that it found.
        graph: Its graph.
        doubts: Sentences on where the map may be wrong.
    """

    poses: Floats
    loops: list[Loop]
    graph: PoseGraph
    doubts: list[str]


class Mapper:
    """Maps while it is given scans.

    Args:
        angles: (B,) the beams' directions, evenly spaced [rad].
        max_range: Ranges from here on are no returns [m].
        mount: (3,) where the laser sits on the robot [m, m, rad].
        parameters: Settings.

    Attributes:
        pose: (3,) where the robot is now.

    Raises:
        EstimatorError: The beams are fewer than two or unevenly spaced.
    """

    def __init__(
        self,
        angles: Floats,
        max_range: float,
        mount: Sequence[float] | Floats = (0.0, 0.0, 0.0),
        parameters: MapParameters | None = None,
    ) -> None:
        steps = np.diff(angles)
        if len(angles) < 2 or not np.allclose(steps, steps[0], atol=1e-3) or abs(float(steps.mean())) < 1e-6:
            raise EstimatorError(f"the {len(angles)} beams are not evenly spaced; at least two are needed")
        self.parameters = parameters or MapParameters()
        fan = BeamFan(float(angles[0]), float(steps.mean()), len(angles))
        self.front = FrontEnd(fan, self.parameters.front_end)
        self.back = BackEnd(self.front, self.parameters.visits)
        self._scans: list[NDArray[np.float32]] = []
        self.max_range, self.mount = max_range, np.asarray(mount, np.float64)
        self.pose = np.zeros(3)

    def add(self, time: float, odometry_pose: Floats, ranges: NDArray[np.float32], unsure: bool = False) -> Floats:
        """Take in a scan; where it closes a loop, the robot is where the closed map says.

        Args:
            time: Of the scan [s].
            odometry_pose: (3,) where the robot is by its wheels.
            ranges: (B,) [m]; 0, NaN and what is not below ``max_range`` are no returns.
            unsure: The wheels do not tell how the robot came here from the scan before: they were reset, or lifted.

        Returns:
            (3,) where the robot is.

        Raises:
            EstimatorError: The shapes are wrong or the odometry is not finite.
        """
        odometry, scan = np.asarray(odometry_pose, np.float64), np.asarray(ranges, np.float32)
        if scan.shape != (self.front.fan.beams,):
            raise EstimatorError(f"a scan has shape {scan.shape}; ({self.front.fan.beams},) is needed")
        if odometry.shape != (3,) or not np.isfinite(odometry).all():
            raise EstimatorError(f"the odometry is {odometry_pose}; three finite numbers x, y, theta are needed")
        scan = np.where((scan > 0.0) & (scan < self.max_range * (1.0 - 1e-4)), scan, np.float32(0.0)).astype(np.float32)
        self._scans.append(scan)
        if self.front.add(compose(odometry, self.mount), scan, unsure):
            self.back.extend()
        self.pose = compose(self.back.corrected(self.front.poses[-1]), inverse(self.mount))
        return self.pose

    def finish(self) -> MapResult:
        """Make the best of everything so far; more scans may follow."""
        front = self.front
        if not front.keyframes:
            return _unmapped(front, self.mount)
        columns = self.back.nodes.columns
        keyframes, sources = np.array(front.keyframes, np.int64), self.back.way_edges().pairs[:, 0]
        compared = Compared(columns.numbers, columns.views, sources)
        nodes, edges = adjusted(front, self.back.fitted(), compared=compared)
        scans = keyframes[columns.numbers]
        poses = spread_over(front, keyframes, _with_dropped(self.back, nodes, len(keyframes)))
        others = np.setdiff1d(np.arange(front.count), scans)
        poses[others] = self._matched(poses[others], others, nodes, compared)
        loops, torn = _checked_loops(self.back, keyframes, poses), torn_places(front, nodes, compared)
        graph = PoseGraph(nodes, scans, edges.pairs, edges.motions, edges.information)
        return MapResult(compose(poses, inverse(self.mount)), loops, graph, _doubts(front, loops, scans[torn]))

    def _matched(self, poses: Floats, scans: NDArray[np.int64], nodes: Floats, compared: Compared) -> Floats:
        """(M, 3) poses of scans that are no nodes, once they are matched with the nodes."""
        front, slots = self.front, self.front.slots(compared.numbers)
        moved, ranges = poses.copy(), np.array([self._scans[s] for s in scans]).reshape(-1, front.fan.beams)
        reach = front.parameters.usable_range
        match_with_nodes(front.store, front.fan, front.spare_slot(), ranges, reach, moved, nodes, slots)
        moved[:, 2] = wrapped(moved[:, 2])
        return moved


def _with_dropped(back: BackEnd, nodes: Floats, keyframes: int) -> Floats:
    """(K, 3) poses of all keyframes from those of the nodes (N, 3)."""
    poses = np.zeros((keyframes, 3))
    poses[back.nodes.columns.numbers] = nodes
    if back.ties:
        dropped, to = np.array([tie[:2] for tie in back.ties]).T
        poses[dropped] = compose(poses[to], np.array([tie[2] for tie in back.ties]))
    return poses


def spread_over(front: FrontEnd, scans: NDArray[np.int64], nodes: Floats) -> Floats:
    """(S, 3) poses of all scans from those of the keyframes (K, 3), between which the matched way keeps its shape."""
    matched, every = np.array(front.poses), np.arange(front.count)
    at = np.clip(np.searchsorted(scans, every, side="right") - 1, 0, len(scans) - 1)
    after = np.minimum(at + 1, len(scans) - 1)
    a, b = scans[at], scans[after]
    onwards = compose(nodes[at], between(matched[a], matched))
    gap = compose(nodes[after], between(matched[b], matched)) - onwards
    gap[:, 2] = wrapped(gap[:, 2])
    share = np.clip((every - a) / np.maximum(b - a, 1), 0.0, 1.0)
    poses: Floats = onwards + share[:, None] * gap
    poses[:, 2] = wrapped(poses[:, 2])
    return poses


def _unmapped(front: FrontEnd, mount: Floats) -> MapResult:
    """What is left where no scan could be used: the wheels' way."""
    poses = np.array(front.poses).reshape(-1, 3)
    none = np.zeros((0, 3))
    graph = PoseGraph(none, np.zeros(0, np.int64), np.zeros((0, 2), np.int64), none, np.zeros((0, 3, 3)))
    doubts = ["no scan could be matched; the poses are those of the wheels alone"]
    return MapResult(compose(poses, inverse(mount)), [], graph, doubts)


def _checked_loops(back: BackEnd, keyframes: NDArray[np.int64], poses: Floats) -> list[Loop]:
    """The loops with how far the finished map, with the poses (S, 3) of all scans, disagrees."""
    loops = []
    for one in back.loops:
        later, earlier = int(keyframes[one.later]), int(keyframes[one.earlier])
        error = between(one.motion, between(poses[earlier], poses[later]))
        residual = float(np.hypot(error[0], error[1]))
        kept = residual < _CONTRADICTED and abs(float(error[2])) < _CONTRADICTED
        loops.append(Loop(later, earlier, one.motion, residual, kept))
    return loops


def _doubts(front: FrontEnd, loops: list[Loop], torn: NDArray[np.int64]) -> list[str]:
    """Sentences on where the map may be wrong: what was not matched, and the scans (T, 2) between which it is torn."""
    doubts = []
    held = int(np.sum(front.held))
    if held:
        first = int(np.argmax(front.held))
        doubts.append(f"{held} of {front.count} scans fitted nothing and follow the wheels alone, first scan {first}")
    unlike = int(np.sum(np.array(front.shares[1:]) < _UNLIKE)) - held
    if unlike > _SOME * front.count:
        doubts.append(
            f"{unlike} of {front.count} scans hardly fit what was seen before them; the way may be wrong there"
        )
    if len(torn):
        worst = "; ".join(f"scans {a} and {b}" for a, b in torn[:3])
        doubts.append(
            f"the map is likely torn or folded at {len(torn)} places: what was seen there does not fit ({worst})"
        )
    left = [loop for loop in loops if not loop.kept]
    if left and len(left) > _MANY * len(loops):
        doubts.append(f"{len(left)} of {len(loops)} loops contradict the map; it may be torn")
    return doubts
