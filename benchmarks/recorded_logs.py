"""SLAM on recorded logs: relation errors, speed and memory for every log beside the checkout, in one table.

python benchmarks/recorded_logs.py [--logs ../shared/data/logs] [--seeds 3] [--filter] [--particles 30]

Every log NAME.log[.gz] with relations NAME.relations is mapped by the graph of poses (``lidarena map``), with one
setting for all, over all relations. Mapping is deterministic, so seed 0 is the log as it was recorded; for further
seeds noise is added to what the wheels told: 10% of the way, 0.1 rad a metre and 0.3 rad a radian. ``--filter`` runs
the particle filter instead (``python -m lidarena.slam replay``), whose seeds are its own.

Speeds are scans received a second of processor time on one core, loops and all; memory is the peak of a process that
reads and maps one log. Cartographer's figures, of settings tuned for each log, are those of Hess et al. (ICRA 2016),
tables II to IV, graph mapping's those of Kümmerle et al. (2009), whose relations of CSAIL come from its own result.
On Intel, by the same relations: gmapping with 30 particles 0.059 m, iris_lama's particle filter with 30 0.044 m.
"""

import argparse
import resource
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lidarena.base.terminal import make_output_printable
from lidarena.slam.logs.carmen import RecordedLog, read_log
from lidarena.slam.logs.mapping import map_log
from lidarena.slam.logs.relations import read_relations, relation_errors
from lidarena.slam.logs.replay import replay
from lidarena.slam.logs.trajectory import Trajectory, in_order
from lidarena.slam.planar import between, compose

DATA = Path(__file__).resolve().parents[2] / "shared" / "data" / "logs"
CARTOGRAPHER = {"intel-full": (0.0229, 0.453), "mit-csail": (0.0319, 0.369), "fr079": (0.0452, 0.538)}
GRAPH_MAPPING = {"intel-full": (0.031, 1.3), "mit-csail": (0.004, 0.05), "fr079": (0.056, 0.6)}
RELATIONS = {"intel-full": "intel"}
"""Logs whose relations have another name."""


class Row(NamedTuple):
    """A line of the table: errors [m, °], scans a second, peak memory [MiB] and what the run doubts."""

    name: str
    translation: float
    rotation: float
    speed: float | None = None
    memory: float | None = None
    doubts: tuple[str, ...] = ()

    def __str__(self) -> str:
        speed = "" if self.speed is None else f"{self.speed:,.0f}"
        memory = "" if self.memory is None else f"{self.memory:,.0f} MiB"
        return f"  {self.name:<28}{self.translation:>9.4f} m{self.rotation:>8.2f}°{speed:>9}{memory:>12}"


def noisy(log: RecordedLog, seed: int) -> RecordedLog:
    """The log with noise on what its wheels told; as it is for seed 0."""
    if seed == 0:
        return log
    rng, steps = np.random.default_rng(seed), between(log.odometry[:-1], log.odometry[1:])
    way = np.hypot(steps[:, 0], steps[:, 1])
    steps[:, :2] *= 1.0 + 0.1 * rng.normal(size=(len(way), 1))
    steps[:, 2] += (0.1 * way + 0.3 * np.abs(steps[:, 2])) * rng.normal(size=len(way))
    poses = [log.odometry[0]]
    for step in steps:
        poses.append(compose(poses[-1], step))
    return replace(log, odometry=np.array(poses))


def measured(name: str, folder: Path, seed: int, particles: int) -> Row:
    """Map one log, in a process of its own; with particles > 0 by the filter."""
    log = read_log(file_of(name, folder))
    if particles:
        result = replay(log, particles, seed)
        trajectory, speed, doubts = result.trajectory, result.updates_per_second, list[str]()
    else:
        mapped = map_log(noisy(log, seed))
        trajectory, speed, doubts = mapped.trajectory, len(log.ranges) / mapped.seconds, mapped.doubts
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return Row(f"Lidarena, seed {seed}", *errors(name, folder, trajectory), speed, memory, tuple(doubts))


def errors(name: str, folder: Path, trajectory: Trajectory) -> tuple[float, float]:
    """Mean errors [m, °] over all relations."""
    relations = read_relations(folder / f"{RELATIONS.get(name, name)}.relations")
    found = relation_errors(trajectory.times, trajectory.poses, relations, name)
    return float(found.translation.mean()), float(np.degrees(found.rotation.mean()))


def file_of(name: str, folder: Path) -> Path:
    """Where a log lies."""
    plain = folder / f"{name}.log"
    return plain if plain.exists() else folder / f"{name}.log.gz"


def show(name: str, folder: Path, seeds: int, particles: int) -> None:
    """Print the rows of one log."""
    log = read_log(file_of(name, folder))
    print(f"{name}: {len(log.ranges):,} scans of {len(log.angles)} beams", flush=True)
    print(Row("wheels", *errors(name, folder, in_order(log.times, log.odometry))))
    for rival, figures in (("Cartographer, published", CARTOGRAPHER), ("graph mapping, published", GRAPH_MAPPING)):
        if name in figures:
            print(Row(rival, *figures[name]), flush=True)
    for seed in range(seeds):
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as own:
            row = own.submit(measured, name, folder, seed, particles).result()
        print(row)
        for doubt in row.doubts:
            print(f"      {doubt}", flush=True)


def main() -> int:
    """Run all logs that are there."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--logs", type=Path, default=DATA, help="folder of NAME.log[.gz], NAME.relations")
    parser.add_argument("--only", nargs="*", help="names of logs; all of them if left out")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--filter", action="store_true", help="the particle filter instead of the graph of poses")
    parser.add_argument("--particles", type=int, default=30, help="of the filter")
    options = parser.parse_args()
    files = sorted([*options.logs.glob("*.log"), *options.logs.glob("*.log.gz")])
    names = [file.name.removesuffix(".gz").removesuffix(".log") for file in files]
    chosen = [name for name in names if not options.only or name in options.only]
    if not chosen:
        print(f"skipped: there are no such recorded logs at {options.logs}", file=sys.stderr)
        return 0
    for name in chosen:
        if (options.logs / f"{RELATIONS.get(name, name)}.relations").exists():
            show(name, options.logs, options.seeds, options.particles if options.filter else 0)
    return 0


if __name__ == "__main__":
    sys.exit(main())
