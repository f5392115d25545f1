"""The lidar kernel against pymunk's ray query: every beam compared, and rays a second on one core.

python benchmarks/lidar.py [--poses 10000]
"""

import argparse
import math
import time

import numpy as np
import pymunk
from numpy.typing import NDArray

from lidarena.base.terminal import make_output_printable
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec
from lidarena.world.load import load_floorplan
from lidarena.world.spaces import build_space

PLANS = ("env1", "env2", "env3", "env4", "willow_lobby", "turtlebot3_world", "aws_small_house", "willow")
BEAMS, REACH = 36, 3.5


def free_poses(plan: Floorplan, count: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Random poses (count, 1, 3) with 0.12 m of clearance."""
    raster = plan.raster(0.05)
    cells = np.argwhere(~raster.solid & (raster.clearance > 0.15))
    chosen = cells[rng.integers(len(cells), size=count)][:, ::-1] + rng.uniform(0.25, 0.75, (count, 2))
    headings = rng.uniform(-np.pi, np.pi, (count, 1))
    return np.hstack([raster.origin + chosen * raster.resolution, headings])[:, None]


def pymunk_ranges(space: pymunk.Space, poses: NDArray[np.float64], beams: int) -> NDArray[np.float64]:
    """Ranges (poses, beams) by ``segment_query_first``."""
    ranges = np.full((len(poses), beams), REACH)
    everything = pymunk.ShapeFilter()
    for i, (x, y, theta) in enumerate(poses[:, 0].tolist()):
        for k in range(beams):
            angle = theta + k * 2 * math.pi / beams
            end = (x + REACH * math.cos(angle), y + REACH * math.sin(angle))
            hit = space.segment_query_first((x, y), end, 0.0, everything)
            if hit is not None:
                ranges[i, k] = REACH * hit.alpha
    return ranges


def rays_per_second(lidar: Lidar, poses: NDArray[np.float64]) -> float:
    """Best of seven rounds, 360 beams."""
    plan = np.zeros(len(poses), np.int64)
    lidar.cast(poses, plan)
    best = math.inf
    for _ in range(7):
        begin = time.perf_counter()
        lidar.cast(poses, plan)
        best = min(best, time.perf_counter() - begin)
    return len(poses) * lidar.spec.beams / best


def main() -> None:
    """Print both tables."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=10000, help="poses over all maps together")
    count = parser.parse_args().poses // len(PLANS)
    rng = np.random.default_rng(0)
    print(f"{'map':18} {'edges':>6} {'worst beam':>11} {'lidarena':>12} {'pymunk':>12} {'ratio':>7}")
    worst = 0.0
    for name in PLANS:
        plan = load_floorplan(name)
        poses, space = free_poses(plan, count, rng), build_space(plan)
        ours = Lidar([plan], LidarSpec(beams=BEAMS)).cast(poses, np.zeros(count, np.int64))[:, 0]
        begin = time.perf_counter()
        theirs = pymunk_ranges(space, poses, BEAMS)
        pymunk_rate = theirs.size / (time.perf_counter() - begin)
        error = float(np.abs(ours - theirs).max())
        rate = rays_per_second(Lidar([plan]), poses)
        worst = max(worst, error)
        row = f"{error * 1e3:8.4f} mm {rate / 1e6:8.1f} M/s {pymunk_rate / 1e6:8.3f} M/s {rate / pymunk_rate:6.0f}×"
        print(f"{name:18} {len(plan.edges):6} {row}", flush=True)
    print(f"worst of {count * len(PLANS):,} poses × {BEAMS} beams: {worst * 1e3:.4f} mm")


if __name__ == "__main__":
    main()
