"""SLAM on recorded logs: relation errors and speed for every log beside the checkout, seed by seed.

python benchmarks/recorded_logs.py [--logs ../shared/data/logs] [--seeds 5] [--particles 30]

The rows "wheels" are the odometry as it is. Figures of others on the Intel log (all / clean relations, metres), by
the same relations: gmapping with 30 particles 0.059 / 0.041 at 17.5 scan updates a second on one core, iris_lama's
particle filter with 30 particles 0.044 / 0.025 at 63. Speeds are updates a second of processor time, calibration
included.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from lidarena.base.terminal import make_output_printable
from lidarena.slam.logs.carmen import RecordedLog, read_log
from lidarena.slam.logs.relations import Relations, read_relations, relation_errors
from lidarena.slam.logs.replay import replay
from lidarena.slam.logs.trajectory import Trajectory, in_order

DATA = Path(__file__).resolve().parents[2] / "shared" / "data" / "logs"


def errors(trajectory: Trajectory, relations: Sequence[Relations]) -> list[float]:
    """Mean errors [m, °] against every set of relations, one behind the other."""
    found = [relation_errors(trajectory.times, trajectory.poses, each) for each in relations]
    return [value for e in found for value in (float(e.translation.mean()), float(np.degrees(e.rotation.mean())))]


def show(name: str, values: Sequence[float], rest: str) -> None:
    """Print a row."""
    pairs = "".join(f"{values[k]:>13.4f} m{values[k + 1]:>6.2f}°" for k in range(0, len(values), 2))
    print(f"{name:<10}{pairs}  {rest}", flush=True)


def run(log: RecordedLog, relations: Sequence[Relations], seeds: int, particles: int) -> None:
    """Print the table of one log."""
    print(f"{log.name}: {len(log.times):,} readings, {len(log.ranges):,} scans, {particles} particles")
    print(f"{'':<10}" + "".join(f"{each.name:>22}" for each in relations))
    show("wheels", errors(in_order(log.times, log.odometry), relations), "")
    rows, speeds = [], []
    for seed in range(seeds):
        result = replay(log, particles, seed)
        rows.append(errors(result.trajectory, relations))
        speeds.append(result.updates_per_second)
        show(f"seed {seed}", rows[-1], f"{len(result.readings):,} updates, {speeds[-1]:,.0f} a second")
    if rows:
        show("mean", np.mean(rows, axis=0).tolist(), f"{np.mean(speeds):,.0f} a second")
        show("worst", np.max(rows, axis=0).tolist(), f"{np.min(speeds):,.0f} a second")
    print()


def main() -> int:
    """Run all logs that are there."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--logs", type=Path, default=DATA, help="folder of NAME.log[.gz], NAME*.relations")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--particles", type=int, default=30)
    options = parser.parse_args()
    logs = sorted([*options.logs.glob("*.log"), *options.logs.glob("*.log.gz")])
    if not logs:
        print(f"skipped: there are no recorded logs at {options.logs}", file=sys.stderr)
        return 0
    for file in logs:
        name = file.name.removesuffix(".gz").removesuffix(".log")
        relations = [read_relations(path) for path in sorted(options.logs.glob(f"{name}*.relations"))]
        run(read_log(file), sorted(relations, key=lambda each: -len(each.times)), options.seeds, options.particles)
    return 0


if __name__ == "__main__":
    sys.exit(main())
