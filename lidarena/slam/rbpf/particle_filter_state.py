"""What a batch of particle filters is made of: its settings and its arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.rbpf.likelihood_field import Fields, empty_fields
from lidarena.slam.rbpf.point_blocks import Workspace, empty_blocks, empty_workspaces
from lidarena.slam.rbpf.scan_matching import MatcherParameters
from lidarena.slam.rbpf.scan_points import PointParameters
from lidarena.slam.scan_outline import Outlines, empty_outlines
from lidarena.world.odometry import OdometryNoise


class FilterParameters(NamedTuple):
    """Settings of the filter; the update rule is turtlebot3_slam's.

    Attributes:
        particles: N.
        linear_update: A scan is processed when the robot travelled this far [m], …
        angular_update: … or turned this far [rad], …
        temporal_update: … or when more than this has passed [s]; infinity switches the clock off.
        resample_share: Resample when N_eff falls below this share of N.
        likelihood_gain: Factor on the scans' log-likelihood. Beams err together, and all of them against a map that
            erred before: taken at face value they end every doubt and the filter grows overconfident. With this factor
            the error of the pose is as large as its covariance says (``benchmarks/filter_accuracy.py``).
        hysteresis: The published map leaves its particle's descendants only for one this many times as likely.
        history: Scans that the published map can take back.
        traced: Whether the map is published; without it only the particles' own maps and pasts are kept.
        starts: Sampled motions that are tried before the first particle is matched.
        turned_starts: How many steps of 0.03 rad to each side of the odometry are tried, too; for wheels that are read
            too early or too late in a turn.
        stride: One of so many points of a scan is used; which ones, changes from scan to scan.
        noise: The odometry's noise, per reading.
        points: How points are made of a scan.
        matcher: The scan matcher's settings.
    """

    particles: int = 30
    linear_update: float = 1.0
    angular_update: float = 0.2
    temporal_update: float = 0.5
    resample_share: float = 0.5
    likelihood_gain: float = 0.005
    hysteresis: float = 3.0
    history: int = 256
    traced: bool = True
    starts: int = 8
    turned_starts: int = 0
    stride: int = 2
    noise: OdometryNoise = OdometryNoise()
    points: PointParameters = PointParameters()
    matcher: MatcherParameters = MatcherParameters()


class Scratch(NamedTuple):
    """What a kernel works on within one call, one row for each world that a call may begin with: leaves no trace.

    Attributes:
        means: (W, beams, 2) the scan's averaged hits.
        points: (W, blocks, 5, BLOCK) those of them that are registered.
        flat: (W, beams) which of them have a normal.
        numbers: (W, beams or N) integers.
        chosen: (W, blocks, 5, BLOCK) the points that are matched.
        work: For one block of points at a time.
        poses: (W, 2, 3) poses.
        outlines: Of the scans that are traced.
    """

    means: NDArray[np.float64]
    points: NDArray[np.float64]
    flat: NDArray[np.bool_]
    numbers: NDArray[np.int64]
    chosen: NDArray[np.float64]
    work: Workspace
    poses: NDArray[np.float64]
    outlines: Outlines


def empty_scratch(
    worlds: int, rows: int, beams: int, max_range: float, resolution: float, parameters: FilterParameters
) -> Scratch:
    """Allocate it."""
    return Scratch(
        np.zeros((worlds, beams, 2)),
        np.stack([empty_blocks(beams)] * worlds),
        np.zeros((worlds, beams), np.bool_),
        np.zeros((worlds, max(beams, parameters.particles)), np.int64),
        np.stack([empty_blocks(parameters.matcher.points)] * worlds),
        empty_workspaces(worlds),
        np.zeros((worlds, 2, 3)),
        empty_outlines(worlds, rows, beams, max_range, resolution),
    )


class FilterState(NamedTuple):
    """Arrays of a batch of filters: ``W`` worlds, ``N`` particles, ``H`` past scans, grids of ``R`` × ``C`` cells.

    Attributes:
        fields: The particles' likelihood fields.
        particles: (W, N, 3) poses.
        anchors: (W, N, 3) poses at the last processed scan.
        log_weights: (W, N).
        weights: (W, N) normalised.
        scores: (W, N) log-likelihoods of the scans since the last resampling, added up as they are.
        motion: (W, 3) odometry since the last processed scan, in the robot's frame then.
        motion_covariance: (W, 3, 3) of it.
        since: (W, 3) distance [m], turn [rad] and time [s] since then.
        ancestors: (W, N) which particle of the last scan each one continues.
        node_poses: (W, H, N, 3) poses at past scans, a ring over scans.
        node_parents: (W, H, N) which particle of the scan before each one continues.
        node_scans: (W, H, beams) float32.
        published: (W, H) particle whose pose each scan was traced from.
        updates: (W,) scans processed.
        estimate: (W, 3) weighted mean pose.
        covariance: (W, 3, 3).
        criteria: (W, 4) D-optimality, entropy of the weights, N_eff, gmapping's entropy.
    """

    fields: Fields
    particles: NDArray[np.float64]
    anchors: NDArray[np.float64]
    log_weights: NDArray[np.float64]
    weights: NDArray[np.float64]
    scores: NDArray[np.float64]
    motion: NDArray[np.float64]
    motion_covariance: NDArray[np.float64]
    since: NDArray[np.float64]
    ancestors: NDArray[np.int64]
    node_poses: NDArray[np.float64]
    node_parents: NDArray[np.int16]
    node_scans: NDArray[np.float32]
    published: NDArray[np.int16]
    updates: NDArray[np.int64]
    estimate: NDArray[np.float64]
    covariance: NDArray[np.float64]
    criteria: NDArray[np.float64]


def empty_state(worlds: int, rows: int, columns: int, beams: int, parameters: FilterParameters) -> FilterState:
    """Allocate the arrays of ``worlds`` filters on grids of rows × columns cells."""
    n, h = parameters.particles, parameters.history
    return FilterState(
        fields=empty_fields(worlds, n, rows, columns),
        particles=np.zeros((worlds, n, 3)),
        anchors=np.zeros((worlds, n, 3)),
        log_weights=np.zeros((worlds, n)),
        weights=np.full((worlds, n), 1.0 / n),
        scores=np.zeros((worlds, n)),
        motion=np.zeros((worlds, 3)),
        motion_covariance=np.zeros((worlds, 3, 3)),
        since=np.zeros((worlds, 3)),
        ancestors=np.tile(np.arange(n), (worlds, 1)),
        node_poses=np.zeros((worlds, h, n, 3)),
        node_parents=np.zeros((worlds, h, n), np.int16),
        node_scans=np.zeros((worlds, h, beams), np.float32),
        published=np.zeros((worlds, h), np.int16),
        updates=np.zeros(worlds, np.int64),
        estimate=np.zeros((worlds, 3)),
        covariance=np.zeros((worlds, 3, 3)),
        criteria=np.zeros((worlds, 4)),
    )
