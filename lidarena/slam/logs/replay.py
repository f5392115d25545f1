"""SLAM on a recorded log: the particle filter from the first scan to the last, and what it makes of the whole past."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.slam.logs.attempts import ALONE, Attempt, Spread, choose_attempt
from lidarena.slam.logs.calibration import OdometryCalibration, calibrated, fit_calibration
from lidarena.slam.logs.carmen import LogError, RecordedLog
from lidarena.slam.logs.traced_map import beam_directions, informative_ranges, laser_odometry, traced
from lidarena.slam.logs.trajectory import Trajectory, in_order, spread_correction
from lidarena.slam.planar import between, compose, inverse
from lidarena.slam.rbpf.growth import enlarged, tiles_missing
from lidarena.slam.rbpf.likelihood_field import CELL, TILE
from lidarena.slam.rbpf.particle_filter import ParticleFilters
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
from lidarena.slam.rbpf.scan_matching import MatcherParameters
from lidarena.slam.rbpf.scan_points import points_for
from lidarena.world.extent import check_extent
from lidarena.world.map_server import OccupancyMap

MAX_PARTICLES = 1000
_CALIBRATING = 5
"""Particles of the run that calibrates: it needs motions from scan to scan, and no loop to close."""
_MARGIN, _GROWTH = 2.0, 10.0
"""The grid is enlarged when a scan could end nearer to its border than the one, and then by so much more [m]."""

Progress = Callable[[int, int], None]
"""Called with the scans that are done and the scans of the log."""

REPLAY_FILTER = FilterParameters(
    linear_update=0.3,
    temporal_update=math.inf,
    likelihood_gain=0.0025,
    traced=False,
    starts=30,
    turned_starts=10,
    stride=1,
    matcher=MatcherParameters(points=96),
)
"""The filter's settings for a robot of a building's size with a laser of a half turn. A scan is used every 0.3 m or
0.2 rad, whole, whatever the clock says; the log's clock may stand still or jump."""


@dataclass(frozen=True)
class ReplayParameters:
    """Settings of a replay.

    Attributes:
        usable_range: Ranges beyond this are only known to be free up to here [m].
        jump_beams: Hits on one surface are at most this many beam spacings apart.
        normal_beams: A wall's normal is fitted over at least this many beam spacings to both sides.
        calibrate: Whether a first run with a few particles finds out what the wheels get wrong all along.
        attempts: Independent runs of the filter, of which the one whose scans agree best on a map counts: with 30
            particles one run in some ten to twenty loses its way in a fast turn or closes a loop beside the truth.
        filter: The filter's. Its ``history`` is always the whole log, and its ``points`` follow the two above.
    """

    usable_range: float = 20.0
    jump_beams: float = 2.9
    normal_beams: float = 2.6
    calibrate: bool = True
    attempts: int = 3
    filter: FilterParameters = REPLAY_FILTER


@dataclass(frozen=True)
class Replay:
    """What SLAM made of a log.

    Attributes:
        trajectory: The robot's pose at every time stamp of the log, by the best particle's whole past.
        readings: (K,) which readings of the log had their scan processed.
        poses: (K, 3) the laser's poses then.
        map: The occupancy grid of all processed scans.
        calibration: What was found out about the wheels.
        seconds: Processor time of the filter in all its runs, without what it took to compile.
        evidence: How well each attempt's scans agree on a map, see ``TracedMap``; the largest was taken.
        spread: How far the other attempts are from it, see ``attempts.Spread``.
    """

    trajectory: Trajectory
    readings: NDArray[np.int64]
    poses: NDArray[np.float64]
    map: OccupancyMap
    calibration: OdometryCalibration
    seconds: float
    evidence: tuple[float, ...] = ()
    spread: Spread = ALONE

    @property
    def updates_per_second(self) -> float:
        """Scans that the filter processed in a second of processor time."""
        return len(self.readings) / max(self.seconds, 1e-9)


def replay(
    log: RecordedLog,
    particles: int = 30,
    seed: int = 0,
    parameters: ReplayParameters | None = None,
    progress: Progress | None = None,
) -> Replay:
    """Run the particle filter over a recorded log, on one core, several times, and keep what fits best.

    The map and the trajectory are in the frame of the log's odometry at its first scan.

    Args:
        log: As `lidarena.slam.logs.carmen.read_log` gives it.
        particles: Of the filter.
        seed: The same seed gives the same bits.
        parameters: Settings.
        progress: Told now and then how far it is.

    Raises:
        LogError: ``particles`` or ``seed`` are out of range.
        MapError: The robot went farther than any map may reach.
    """
    if not 1 <= particles <= MAX_PARTICLES:
        raise LogError(f"{particles} particles are asked for; 1 to {MAX_PARTICLES} are allowed")
    if seed < 0:
        raise LogError(f"the seed is {seed}; 0 or more is needed")
    settings = parameters or ReplayParameters()
    odometry, calibration, seconds = laser_odometry(log), OdometryCalibration(), 0.0
    first, passes = int(settings.calibrate), int(settings.calibrate) + settings.attempts
    if settings.calibrate:
        run = _Run(log, odometry[log.scan_readings], min(particles, _CALIBRATING), (seed, 0), settings)
        run.forward(progress, 0, passes)
        calibration, seconds = run.calibration(), run.seconds
        odometry = calibrated(odometry, calibration)
    found = []
    for attempt in range(settings.attempts):
        run = _Run(log, odometry[log.scan_readings], particles, (seed, attempt + 1), settings)
        run.forward(progress, first + attempt, passes)
        scans, poses = run.past()
        made = traced(log, scans, poses, settings.usable_range)
        path = spread_correction(odometry, log.scan_readings[scans], poses)[log.scan_readings]
        found.append(Attempt(scans, poses, made, path))
        seconds += run.seconds
    best, spread = choose_attempt(found)
    grid, scans, poses = found[best].made.grid, found[best].scans, found[best].poses
    readings = log.scan_readings[scans]
    corrected = compose(spread_correction(odometry, readings, poses), inverse(log.mount))
    return Replay(
        trajectory=in_order(log.times, corrected),
        readings=readings,
        poses=poses,
        map=grid,
        calibration=calibration,
        seconds=seconds,
        evidence=tuple(each.made.evidence for each in found),
        spread=spread,
    )


class _Run:
    """One filter on its way through a log.

    Args:
        log: The log.
        odometry: (S, 3) the laser's poses at the scans, by the wheels.
        particles: How many.
        seed: Of the filter's random stream: of the replay, and of the run.
        settings: Of the replay.
    """

    def __init__(
        self,
        log: RecordedLog,
        odometry: NDArray[np.float64],
        particles: int,
        seed: tuple[int, int],
        settings: ReplayParameters,
    ) -> None:
        self.log, self.odometry, self.reach = log, odometry, settings.usable_range + _MARGIN
        self.scans = informative_ranges(log)
        step = float(abs(log.angles[1] - log.angles[0]))
        points = points_for(step, settings.jump_beams, settings.normal_beams)
        history = len(odometry) + 1  # nothing of the past is ever overwritten
        parameters = settings.filter._replace(particles=particles, history=history, points=points, traced=False)
        side = 2 * math.ceil((self.reach + _GROWTH) / (TILE * CELL)) * TILE
        wanted = np.zeros((1, side, side), np.uint8)
        self.filters = ParticleFilters(1, wanted, beam_directions(log), settings.usable_range, CELL, parameters)
        self.stream, self.seconds = seed_stream(np.random.default_rng(seed)), 0.0
        self.processed: list[int] = []
        self.filters.step(0, 0.0, np.zeros(3), self.scans[0], self.stream.copy())  # compiles
        self.filters.start(0, 0, odometry[0, :2] - 0.5 * side * CELL, odometry[0])

    def forward(self, progress: Progress | None, done: int, passes: int) -> None:
        """Filter all scans, in the pass after ``done`` of ``passes``."""
        total, began = len(self.odometry), time.thread_time()
        motions = between(self.odometry[np.maximum(np.arange(total) - 1, 0)], self.odometry)
        for k in range(total):
            self._make_room()
            filters = self.filters
            before = int(filters.state.updates[0])
            filters.step(0, 0.0, motions[k], self.scans[k], self.stream)
            if filters.state.updates[0] > before:
                self.processed.append(k)
            if progress is not None and (k % 50 == 49 or k == total - 1):
                progress(done * total + k + 1, passes * total)
        self.seconds = time.thread_time() - began

    def calibration(self) -> OdometryCalibration:
        """What the wheels got wrong all along."""
        scans, poses = self.past()
        wheels = self.odometry[scans]
        return fit_calibration(between(wheels[:-1], wheels[1:]), between(poses[:-1], poses[1:]))

    def _make_room(self) -> None:
        """Enlarge the grid where a scan could reach beyond it."""
        maps, places = self.filters.maps, self.filters.state.particles[0, :, :2]
        low, high = places.min(axis=0) - self.reach, places.max(axis=0) + self.reach
        missing = tiles_missing(maps.origin[0], maps.wanted.shape[1:], CELL, low, high)
        if any(missing):
            more = math.ceil(_GROWTH / (TILE * CELL))
            below, left, above, right = (tiles + more if tiles else 0 for tiles in missing)
            rows, columns = maps.wanted.shape[1] + (below + above) * TILE, maps.wanted.shape[2] + (left + right) * TILE
            check_extent(f"the way of the robot in log {self.log.name!r}", rows, columns, CELL)
            self.filters = enlarged(self.filters, below, left, above, right)

    def past(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Which scans (K,) were processed, and the poses (K, 3) of the likeliest particle's ancestors then."""
        state = self.filters.state
        # the last resampling gave survivors equal weights: count the descendants of each particle before it
        particle = int(np.bincount(state.ancestors[0], weights=state.weights[0]).argmax())
        poses = np.empty((len(self.processed), 3))
        for node in range(len(self.processed) - 1, -1, -1):
            poses[node] = state.node_poses[0, node, particle]
            particle = int(state.node_parents[0, node, particle])
        return np.array(self.processed, np.int64), poses
