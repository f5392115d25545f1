"""SLAM from the command line.

python -m lidarena.slam replay intel.log.gz --relations intel.relations --out results/intel
"""

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from lidarena.base.terminal import exit_status, make_output_printable
from lidarena.slam.logs.attempts import DOUBTFUL
from lidarena.slam.logs.carmen import read_log
from lidarena.slam.logs.relations import RelationErrors, check_overlap, read_relations, relation_errors
from lidarena.slam.logs.replay import Progress as Advance
from lidarena.slam.logs.replay import Replay, replay
from lidarena.slam.logs.replay_files import FILES, save_replay
from lidarena.slam.logs.results_folder import check_folder


def main(arguments: list[str] | None = None) -> int:
    """Run a command; return 0, 2 for a refusal, 1 for a failure, 130 after Ctrl-C."""
    make_output_printable()
    options = _parser().parse_args(arguments)
    out = options.out or Path("results") / Path(options.log).name.split(".")[0]
    return exit_status(lambda: _replay(options, Path(out)))


def _replay(options: argparse.Namespace, out: Path) -> None:
    """Read and check everything, then do the work, then write."""
    check_folder(out, FILES)
    relations = read_relations(options.relations) if options.relations else None
    log = read_log(options.log, options.skip_torn)
    if relations is not None:
        check_overlap(relations, log.times, log.name)
    skipped = f", {log.skipped:,} torn lines skipped" if log.skipped else ""
    print(f"log:        {len(log.times):,} readings, {len(log.ranges):,} scans of {len(log.angles)} beams{skipped}")
    with _progress() as advance:
        result = replay(log, options.particles, options.seed, progress=advance)
    errors = None
    if relations is not None:
        times, poses = result.trajectory.times, result.trajectory.poses
        errors = relation_errors(times, poses, relations, log.name)
    earlier = save_replay(out, log, result, errors)
    _report(result, errors, out, earlier)


def _report(result: Replay, errors: RelationErrors | None, out: Path, earlier: Path | None) -> None:
    rows, columns = result.map.occupancy.shape
    side = result.map.resolution
    print(f"updates:    {len(result.readings):,} scans, {result.updates_per_second:,.0f} a second of processor time")
    print(f"map:        {columns * side:.1f} x {rows * side:.1f} m in cells of {side:g} m")
    if len(result.evidence) > 1:
        near, far = result.spread.nearest, result.spread.farthest
        print(f"attempts:   {len(result.evidence)}, the others {near:.2f} to {far:.2f} m from the one that fits best")
        if near > DOUBTFUL:
            print("warning:    no two attempts agree; the map may be torn or folded", file=sys.stderr)
    if errors is not None:
        print(f"relations:  {errors}")
    print(f"results:    {out}/picture.png (also map.yaml, map.pgm, trajectory.tum, results.json)")
    if earlier is not None:
        print(f"earlier:    the replay that stood there is now in {earlier}")


@contextmanager
def _progress() -> Iterator[Advance]:
    """A bar on a terminal; elsewhere its last state, once."""
    columns = (TextColumn("scans"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task("scans", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m lidarena.slam", description="SLAM from the command line.")
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("replay", help="map a recorded CARMEN log", description="Map a recorded CARMEN log.")
    command.add_argument("log", metavar="LOG", help="CARMEN log, plain or gzip, such as intel.log.gz")
    command.add_argument("--relations", metavar="FILE", help="true relations; their mean errors are printed")
    command.add_argument("--out", metavar="DIR", help="folder of the results; results/NAME if left out")
    command.add_argument("--particles", type=int, default=30, metavar="N", help="of the filter (default: %(default)s)")
    command.add_argument("--seed", type=int, default=0, metavar="N", help="of the filter (default: %(default)s)")
    command.add_argument("--skip-torn", action="store_true", help="leave torn lines out instead of refusing the log")
    return parser


if __name__ == "__main__":
    sys.exit(main())
