"""Compare policies from a YAML file: tables with 95% intervals, pictures, and videos if asked for.

python evaluate.py --config configs/compare/exploration.yaml --set episodes=50 --out results/mine
"""

import argparse
import json
import sys

from rich.console import Console

from lidarena.base.errors import LidarenaError
from lidarena.base.terminal import make_output_printable
from lidarena.base.yaml_config import load_config
from lidarena.evaluation import Comparison, ComparisonConfig, EpisodeError, compare
from lidarena.evaluation.tables import short_note, terminal_table
from lidarena.evaluation.team_planning.team_experiment import TeamExperimentConfig, is_team_experiment
from lidarena.evaluation.team_planning.team_tables import compare_planners, print_rows

_FAILURES = 10
"""So many maps that could not be used are named in the terminal."""


def main(arguments: list[str] | None = None) -> int:
    """Run a comparison; return 0, 2 for a refusal, 1 for a failure, 130 after Ctrl-C."""
    make_output_printable()
    options = _parser().parse_args(arguments)
    overrides = [*options.set, *([f"out={json.dumps(options.out)}"] if options.out else [])]
    out, err = Console(), Console(stderr=True)
    try:
        if is_team_experiment(options.config):
            rows, folder = compare_planners(load_config(options.config, TeamExperimentConfig, overrides), err)
            print_rows(rows, out)
            out.print(f"tables:   {folder}/table.md (also .csv and results.json)\nfigures:  {folder}/figures.png")
            return 0
        comparison = compare(load_config(options.config, ComparisonConfig, overrides), err)
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    except EpisodeError as error:
        print(error, error.report, sep="\n", end="", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted; no results were written", file=sys.stderr)
        return 130
    out.print(terminal_table(comparison.rows, out.width))
    out.print(short_note(comparison.rows), style="dim", highlight=False)
    for line in _places(comparison):
        out.print(line, highlight=False, markup=False, soft_wrap=True)
    return _tell_failures(comparison.failures)


def _tell_failures(failures: list[str]) -> int:
    """Say which maps could not be used; return 1 if there are any."""
    for sentence in failures[:_FAILURES]:
        print(sentence, file=sys.stderr)
    if len(failures) > _FAILURES:
        print(f"and {len(failures) - _FAILURES} more maps, see results.json", file=sys.stderr)
    if failures:
        print("all other maps were driven in, and are in the results", file=sys.stderr)
    return 1 if failures else 0


def _places(comparison: Comparison) -> list[str]:
    """Where everything is, a line each."""
    lines = [f"tables:   {comparison.folder}/table.md (also .csv, .tex and results.json)"]
    for kind, files in (("pictures", comparison.pictures), ("videos", comparison.videos)):
        if files:
            others = f" and {len(files) - 1} more there" if files[1:] else ""
            lines.append(f"{kind + ':':9} {files[0]}{others}")
    if comparison.earlier is not None:
        lines.append(f"earlier:  the results that stood there are now in {comparison.earlier}")
    return lines


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Compare policies from a YAML file.")
    config_help = "comparison file, such as configs/compare/quick.yaml"
    parser.add_argument("--config", required=True, metavar="FILE", help=config_help)
    set_help = "override keys of the file, such as episodes=50"
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="KEY=VALUE", help=set_help)
    parser.add_argument("--out", metavar="DIR", help="folder of the results; over the file's own 'out'")
    return parser


if __name__ == "__main__":
    sys.exit(main())
