"""The command ``lidarena``: one subcommand a task, each of them thin."""

import argparse
import sys

from lidarena.base.errors import LidarenaError
from lidarena.base.terminal import make_output_printable
from lidarena.cli import map_command

__all__ = ["main"]


def main(arguments: list[str] | None = None) -> int:
    """Run a subcommand; return 0, 2 for a refusal, 130 after Ctrl-C."""
    make_output_printable()
    parser = argparse.ArgumentParser(prog="lidarena", description="2D robot worlds, and SLAM on recorded logs.")
    commands = parser.add_subparsers(dest="command", required=True)
    map_command.add_to(commands)
    options = parser.parse_args(arguments)
    try:
        options.run(options)
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted; nothing was written", file=sys.stderr)
        return 130
    return 0
