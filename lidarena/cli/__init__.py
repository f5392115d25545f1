"""The command ``lidarena``: one subcommand a task, each of them thin."""

import argparse

from lidarena.base.terminal import exit_status, make_output_printable
from lidarena.cli import map_command, odometry_command

__all__ = ["main"]


def main(arguments: list[str] | None = None) -> int:
    """Run a subcommand; return 0, 2 for a refusal, 130 after Ctrl-C."""
    make_output_printable()
    parser = argparse.ArgumentParser(
        prog="lidarena", description="2D robot worlds; SLAM and odometry on recorded logs."
    )
    commands = parser.add_subparsers(dest="command", required=True)
    map_command.add_to(commands)
    odometry_command.add_to(commands)
    options = parser.parse_args(arguments)
    return exit_status(lambda: options.run(options))
