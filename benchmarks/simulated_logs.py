"""SLAM on logs of long loops that are made here: how far off the end of the way is, and whether a map is torn.

python benchmarks/simulated_logs.py [--logs 20] [--first 0] [--length 400]

Logs with an even number are driven through the plan of Willow Garage, those with an odd number through a maze of
45 x 45 m that is drawn anew each time. The robot goes from one far place to another and comes back to where it began.
Its wheels have twice gmapping's noise and slip by up to 30° in some of the turns; its laser has 181 beams over a half
turn and reaches 30 m. A map counts as torn where its way is more than 0.5 m from the true one, once both are laid over
each other.
"""

import argparse
import math
import sys
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.base.terminal import make_output_printable
from lidarena.planning.grid.grid_search import find_path, path_costs
from lidarena.slam.logs.mapping import map_log
from lidarena.slam.logs.recorded_log import RecordedLog
from lidarena.slam.planar import between, compose, wrapped
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec
from lidarena.world.load import load_floorplan
from lidarena.world.maze import generate_maze
from lidarena.world.odometry import OdometryNoise, read_odometry

Floats = NDArray[np.float64]

LASER = LidarSpec(beams=181, max_range=30.0, field_of_view=math.pi)
NOISE = OdometryNoise().scaled(2.0)
STEP, TURN = 0.1, 0.1
"""From one reading of the wheels to the next [m, rad]; every second one comes with a scan."""
SLIPS, SLIP, SHARP = 0.15, math.radians(30.0), 0.6
"""Share of the turns of more than ``SHARP`` rad in which the wheels slip, and by how much at most."""
ROOM = 0.35
"""Least distance from walls [m]."""
TORN = 0.5
"""Farther from the true way is torn [m]."""


def plan_of(number: int) -> Floorplan:
    """The plan of a log."""
    if number % 2 == 0:
        return load_floorplan("willow")
    rng = np.random.default_rng((number, 1))
    return generate_maze(number, 45.0, 45.0, corridor=float(rng.uniform(1.6, 2.6)), loops=0.2, dead_ends=0.5)


def drive(plan: Floorplan, rng: np.random.Generator, length: float) -> Floats:
    """(n, 3) true poses on a way of about so many metres that ends where it began."""
    raster = plan.raster(STEP)
    cost = np.where(raster.clearance < ROOM, np.inf, 1.0 + 0.3 / np.maximum(raster.clearance, 0.05))
    cost[raster.solid] = np.inf

    def cell(point: Floats) -> tuple[int, int]:
        column, row = ((point - raster.origin) / STEP).astype(int)
        return int(row), int(column)

    start = cell(np.array(plan.start[:2]))
    reachable = np.argwhere(np.isfinite(path_costs(cost, start)))
    cells, driven = [start], 0.0
    while True:
        far = np.hypot(*(reachable - cells[-1]).T) * STEP
        goals = reachable[(far > 12.0) & (far < 30.0)]
        goal = tuple(int(c) for c in goals[rng.integers(len(goals))]) if driven < length else start
        leg = find_path(cost, cells[-1], (goal[0], goal[1]))
        driven += STEP * len(leg)
        cells += [(int(row), int(column)) for row, column in leg[1:]]
        if goal == start:
            return _poses(raster.origin + (np.array(cells)[:, ::-1] + 0.5) * STEP)


def _poses(points: Floats) -> Floats:
    """(n, 3) poses along a way (m, 2), rounded a little, in steps that wheels report."""
    kernel = np.ones(7) / 7.0
    padded = np.concatenate([np.repeat(points[:1], 3, 0), points, np.repeat(points[-1:], 3, 0)])
    smooth = np.stack([np.convolve(padded[:, k], kernel, "valid") for k in (0, 1)], axis=1)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(smooth, axis=0).T))])
    at = np.arange(0.0, way[-1], STEP)
    x, y = (np.interp(at, way, smooth[:, k]) for k in (0, 1))
    headings = np.arctan2(np.gradient(y), np.gradient(x))
    poses: list[Floats] = []
    for k in range(len(at)):
        here = np.array([x[k], y[k], headings[k]])
        if poses:
            by = float(wrapped(np.array(here[2] - poses[-1][2])))
            turns = np.linspace(0.0, by, max(math.ceil(abs(by) / TURN), 1), endpoint=False)[1:]
            poses += [np.array([x[k], y[k], poses[-1][2] + turn]) for turn in turns.tolist()]
        poses.append(here)
    return np.array(poses)


def wheels_of(truth: Floats, rng: np.random.Generator) -> Floats:
    """(n, 3) what the wheels make of a true way: noise, and slip in some of the turns."""
    streams, reading = seed_stream(rng)[None], np.zeros((1, 1, 3))
    turning = np.abs(wrapped(np.diff(truth[:, 2]))) > 0.04
    edges = np.flatnonzero(np.diff(np.concatenate([[False], turning, [False]]).astype(int)))
    slips = np.zeros(len(truth))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        turned = abs(float(np.sum(wrapped(np.diff(truth[first : last + 1, 2])))))
        if turned > SHARP and rng.random() < SLIPS:
            slips[rng.integers(first + 1, last + 1)] = rng.uniform(-SLIP, SLIP)
    poses = [truth[0]]
    for k in range(1, len(truth)):
        read_odometry(0, 1, truth[None, k - 1 : k], truth[None, k : k + 1], NOISE, streams, reading)
        poses.append(compose(poses[-1], reading[0, 0] + (0.0, 0.0, slips[k])))
    return np.array(poses)


def simulated_log(number: int, length: float) -> tuple[RecordedLog, Floats]:
    """A log and its true poses (n, 3); the same number gives the same log."""
    rng, plan = np.random.default_rng((number, 0)), plan_of(number)
    truth = drive(plan, rng, length)
    scans = np.arange(0, len(truth), 2)
    lidar = Lidar([plan], LASER)
    exact = np.concatenate([lidar.cast(truth[s : s + 1][:, None], np.zeros(1, np.int64))[:, 0] for s in scans])
    noisy = np.clip(exact + rng.normal(0.0, LASER.noise, exact.shape), 0.01, None)
    log = RecordedLog(
        name=f"{plan.name}, {number}",
        times=np.asarray(1e9 + 0.2 * np.arange(len(truth)), np.float64),
        odometry=wheels_of(truth, rng),
        scan_readings=scans,
        ranges=np.where(exact < LASER.max_range, noisy, LASER.max_range).astype(np.float32),
        angles=LASER.angles,
        max_range=LASER.max_range,
        mount=np.zeros(3),
    )
    return log, truth


class Outcome(NamedTuple):
    """How far a way is from the true one: at its end, and at worst once both are laid over each other [m]."""

    end: float
    worst: float


def compare(poses: Floats, truth: Floats) -> Outcome:
    """Compare two ways (n, 3)."""
    moved, true = between(poses[0], poses), between(truth[0], truth)
    end = float(np.hypot(*(moved[-1, :2] - true[-1, :2])))
    a, b = moved[:, :2] - moved[:, :2].mean(axis=0), true[:, :2] - true[:, :2].mean(axis=0)
    turn = math.atan2(float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])), float(np.sum(a * b)))
    cos, sin = math.cos(turn), math.sin(turn)
    off = np.stack([cos * a[:, 0] - sin * a[:, 1], sin * a[:, 0] + cos * a[:, 1]], axis=1) - b
    return Outcome(end, float(np.hypot(off[:, 0], off[:, 1]).max()))


def main() -> int:
    """Make and map the logs, one after the other."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--logs", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="number of the first log")
    parser.add_argument("--length", type=float, default=400.0, help="of a way [m], about")
    options = parser.parse_args()
    outcomes = []
    print(f"{'log':<12}{'scans':>7}{'wheels':>10}{'end':>10}{'worst':>10}{'loops':>8}{'scans/s':>9}")
    for number in range(options.first, options.first + options.logs):
        log, truth = simulated_log(number, options.length)
        result = map_log(log)
        found, wheels = compare(result.trajectory.poses, truth), compare(log.odometry, truth)
        outcomes.append(found)
        row = f"{log.name:<12}{len(log.ranges):>7,}{wheels.end:>8.2f} m{found.end:>8.3f} m{found.worst:>8.3f} m"
        speed = len(log.ranges) / result.seconds
        print(
            f"{row}{sum(loop.kept for loop in result.loops):>8}{speed:>9,.0f}  {'; '.join(result.doubts)}", flush=True
        )
    ends, torn = [one.end for one in outcomes], sum(one.worst > TORN for one in outcomes)
    print(
        f"torn: {torn} of {len(outcomes)}; end off by {np.median(ends):.3f} m in the median, {max(ends):.3f} m at most"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
