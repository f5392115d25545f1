"""``lidarena evaluate``: compare policies; tables with 95% intervals, pictures, a report, and videos if asked for."""

import argparse
import json
import sys
from typing import TYPE_CHECKING

from rich.console import Console

from lidarena.base.errors import LidarenaError
from lidarena.base.yaml_config import load_config
from lidarena.cli.config_names import find_config
from lidarena.cli.engine_options import add_engine, engine_overrides
from lidarena.cli.shell_completion import complete_names
from lidarena.cli.standalone import run_alone

if TYPE_CHECKING:
    from lidarena.evaluation import Comparison

_TEXT = "Compare policies from a YAML file."
_FAILURES = 10
"""So many maps that could not be used are named in the terminal."""


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's."""
    parser = commands.add_parser("evaluate", help="compare policies: tables, pictures, report", description=_TEXT)
    _add_options(parser)


def main(arguments: list[str] | None = None) -> int:
    """Run a comparison; return 0, 2 for a refusal, 1 for a failure, 130 after Ctrl-C."""
    return run_alone(_TEXT, _add_options, arguments)


def run(options: argparse.Namespace) -> int:
    """Run a comparison; return 0, 2 for a refusal, 1 for a failure, 130 after Ctrl-C."""
    from lidarena.evaluation.runner import EpisodeError  # here, since it takes seconds to load PyTorch

    if bool(options.name) == bool(options.config):
        options.refuse("give one configuration, by its name or with --config FILE")
    overrides = [*options.set, *([f"out={json.dumps(options.out)}"] if options.out else [])]
    overrides += ["record=true"] if options.record else []
    overrides += engine_overrides(options)
    try:
        return _compare(find_config("compare", options.config or options.name), overrides)
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    except EpisodeError as error:
        print(error, error.report, sep="\n", end="", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted; no results were written", file=sys.stderr)
        return 130


def _compare(file: str, overrides: list[str]) -> int:
    from lidarena.evaluation import ComparisonConfig, comparison
    from lidarena.evaluation.tables import short_note, terminal_table
    from lidarena.evaluation.team_planning.team_experiment import TeamExperimentConfig, is_team_experiment
    from lidarena.evaluation.team_planning.team_tables import compare_planners, print_rows

    out, err = Console(), Console(stderr=True)
    if is_team_experiment(file):
        rows, folder = compare_planners(load_config(file, TeamExperimentConfig, overrides), err)
        print_rows(rows, out)
        out.print(f"tables:   {folder}/table.md (also .csv and results.json)\nfigures:  {folder}/figures.png")
        return 0
    found = comparison.compare(load_config(file, ComparisonConfig, overrides), err)
    out.print(terminal_table(found.rows, out.width))
    out.print(short_note(found.rows), style="dim", highlight=False)
    for line in _places(found):
        out.print(line, highlight=False, markup=False, soft_wrap=True)
    return _tell_failures(found.failures)


def _tell_failures(failures: list[str]) -> int:
    """Say which maps could not be used; return 1 if there are any."""
    for sentence in failures[:_FAILURES]:
        print(sentence, file=sys.stderr)
    if len(failures) > _FAILURES:
        print(f"and {len(failures) - _FAILURES} more maps, see results.json", file=sys.stderr)
    if failures:
        print("all other maps were driven in, and are in the results", file=sys.stderr)
    return 1 if failures else 0


def _places(comparison: "Comparison") -> list[str]:
    """Where everything is, a line each."""
    lines = [f"tables:   {comparison.folder}/table.md (also .csv, .tex and results.json)"]
    for kind, files in (("pictures", comparison.pictures), ("videos", comparison.videos)):
        if files:
            others = f" and {len(files) - 1} more there" if files[1:] else ""
            lines.append(f"{kind + ':':9} {files[0]}{others}")
    report = comparison.folder / "report.html"
    if report.is_file():
        lines.append(f"report:   {report}")
    if comparison.earlier is not None:
        lines.append(f"earlier:  the results that stood there are now in {comparison.earlier}")
    return lines


def _add_options(parser: argparse.ArgumentParser) -> None:
    name_help = "a shipped configuration, such as quick (see lidarena list configs), or a file"
    complete_names(parser.add_argument("name", nargs="?", metavar="NAME", help=name_help), "compare")
    config_help = "comparison file, such as configs/compare/quick.yaml"
    parser.add_argument("--config", metavar="FILE", help=config_help)
    set_help = "override keys of the file, such as episodes=50"
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="KEY=VALUE", help=set_help)
    parser.add_argument("--out", metavar="DIR", help="folder of the results; over the file's own 'out'")
    record_help = "write the first episode of each policy as a rosbag 2 (MCAP) for ROS, into DIR/bags"
    parser.add_argument("--record", action="store_true", help=record_help)
    add_engine(parser)
    parser.set_defaults(run=run, refuse=parser.error)
