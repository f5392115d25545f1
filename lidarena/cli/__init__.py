"""The command ``lidarena``: one subcommand a task, each of them thin."""

import argparse
import sys

import lidarena
from lidarena.base.errors import suggest
from lidarena.base.terminal import exit_status, make_output_printable
from lidarena.cli import (
    evaluate_command,
    export_command,
    list_command,
    map_command,
    odometry_command,
    plan_command,
    report_command,
    shell_completion,
    train_command,
)

__all__ = ["main"]

_COMMANDS = (
    train_command,
    evaluate_command,
    map_command,
    odometry_command,
    plan_command,
    report_command,
    export_command,
    list_command,
    shell_completion,
)


def main(arguments: list[str] | None = None) -> int:
    """Run a subcommand; return 0, 1 for a failure, 2 for a refusal, 130 after Ctrl-C."""
    make_output_printable()
    given = sys.argv[1:] if arguments is None else arguments
    parser, names = _program()
    if given and not given[0].startswith("-") and given[0] not in names:
        print(f"lidarena has no command {given[0]!r}{suggest(given[0], names)}", file=sys.stderr)
        return 2
    options = parser.parse_args(given)
    options.program = parser
    return exit_status(lambda: options.run(options))


def _program() -> tuple[argparse.ArgumentParser, list[str]]:
    """The program's parser, and the names of its commands."""
    text = "2D robot worlds with lidar and SLAM in the loop: train agents, compare policies, map recorded logs."
    parser = argparse.ArgumentParser(prog="lidarena", description=text)
    parser.add_argument("--version", action="version", version=f"lidarena {lidarena.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command in _COMMANDS:
        command.add_to(commands)
    return parser, list(commands.choices)
