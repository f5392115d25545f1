"""A subcommand as a program of its own, such as ``train.py``."""

import argparse
from collections.abc import Callable, Sequence

from lidarena.base.terminal import make_output_printable


def run_alone(
    description: str, add_options: Callable[[argparse.ArgumentParser], None], arguments: Sequence[str] | None
) -> int:
    """Parse arguments and run.

    Args:
        description: Shown by ``--help``.
        add_options: Adds the command's options, among them the default ``run``, a function of what was parsed.
        arguments: Instead of those of the process.

    Returns:
        The exit code.
    """
    make_output_printable()
    parser = argparse.ArgumentParser(description=description)
    add_options(parser)
    parsed = parser.parse_args(arguments)
    code: int = parsed.run(parsed)
    return code
