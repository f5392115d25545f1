"""``lidarena map FILE``: a recorded log, CARMEN or rosbag, mapped by a graph of poses."""

import argparse
import math
import sys
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from lidarena.slam.logs.map_files import MAP_FILES, save_log_map
from lidarena.slam.logs.mapping import LogMap, map_log
from lidarena.slam.logs.reading import read_recording
from lidarena.slam.logs.recorded_log import RANGE_UNITS, LogOptions, RecordedLog
from lidarena.slam.logs.relations import check_overlap, read_relations, relation_errors
from lidarena.slam.logs.results_folder import check_folder
from lidarena.slam.rbpf.likelihood_field import CELL
from lidarena.world.extent import MAX_CELLS, check_resolution


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's."""
    text = "Map a recorded log: CARMEN (plain or gzip), rosbag 1, rosbag 2 (sqlite3, MCAP)."
    parser = commands.add_parser("map", help="map a recorded log", description=text)
    add = parser.add_argument
    add("log", metavar="FILE", help="such as intel.log.gz, run.bag, run.mcap, or the folder of a rosbag 2")
    add("--out", metavar="DIR", help="folder of the results; results/NAME if left out")
    add("--relations", metavar="FILE", help="true relations; the mean errors against them are printed")
    add("--scan", metavar="TOPIC", help="of a bag, sensor_msgs/LaserScan; the fullest if left out")
    add("--odom", metavar="TOPIC", help="of a bag, nav_msgs/Odometry or tf; 'none' for scan matching alone")
    add("--cell", type=float, default=CELL, metavar="M", help="side of the map's cells [m] (default: %(default)s)")
    add("--max-range", type=float, metavar="M", help="ranges from here on are no returns [m]")
    add("--fov", type=float, metavar="DEGREES", help="field of view of a FLASER's beams")
    add("--range-unit", default="m", choices=sorted(RANGE_UNITS), help="of the ranges (default: %(default)s)")
    add("--ignore-times", action="store_true", help="go by the order of the readings, not by their time stamps")
    add("--skip-torn", action="store_true", help="leave torn lines or messages out instead of refusing the log")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Read and check everything, then do the work, then write."""
    out = Path(options.out or Path("results") / Path(options.log).name.split(".")[0])
    check_folder(out, MAP_FILES)
    check_resolution("--cell", options.cell)
    relations = read_relations(options.relations) if options.relations else None
    log = read_recording(options.log, _log_options(options))
    if relations is not None:
        check_overlap(relations, log.times, log.name)
    print(f"log:        {len(log.times):,} readings, {len(log.ranges):,} scans of {len(log.angles)} beams")
    for note in log.notes:
        print(f"note:       {note}")
    if log.skipped:
        print(f"note:       {log.skipped:,} torn lines or messages are left out")
    with _bar() as bar:
        task = bar.add_task("scans", total=None)
        result = map_log(log, None, lambda done, total: bar.update(task, completed=done, total=total), options.cell)
    errors = None
    if relations is not None:
        errors = relation_errors(result.trajectory.times, result.trajectory.poses, relations, log.name)
    earlier = save_log_map(out, log, result, errors)
    _report(log, result)
    if errors is not None:
        print(f"relations:  {errors}")
    print(f"results:    {out}/picture.png (also {', '.join(name for name in MAP_FILES if name != 'picture.png')})")
    if earlier is not None:
        print(f"earlier:    the results that stood there are now in {earlier}")


def _log_options(options: argparse.Namespace) -> LogOptions:
    return LogOptions(
        skip_torn=options.skip_torn,
        keep_cut=True,
        max_range=options.max_range,
        field_of_view=None if options.fov is None else math.radians(options.fov),
        range_unit=options.range_unit,
        ignore_times=options.ignore_times,
        scan_topic=options.scan,
        odometry_topic=options.odom,
    )


def _report(log: RecordedLog, result: LogMap) -> None:
    rows, columns = result.map.occupancy.shape
    side, kept = result.map.resolution, sum(loop.kept for loop in result.loops)
    print(f"map:        {columns * side:.1f} x {rows * side:.1f} m in cells of {side:g} m")
    if rows * columns > MAX_CELLS:
        cells = f"{rows * columns / 1e6:.0f} million cells, of which environments load {MAX_CELLS // 10**6}"
        print(f"note:       the map has {cells}; larger ones (--cell {2 * side:g}) make it smaller")
    print(f"loops:      {kept:,} closed, {len(result.loops) - kept:,} rejected")
    print(f"speed:      {len(log.ranges) / max(result.seconds, 1e-9):,.0f} scans a second of processor time")
    for doubt in result.doubts:
        print(f"warning:    {doubt}", file=sys.stderr)


def _bar() -> Progress:
    """A bar on a terminal; elsewhere its last state, once."""
    columns: tuple[Any, ...] = (TextColumn("scans"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    return Progress(*columns, console=Console(stderr=True))
