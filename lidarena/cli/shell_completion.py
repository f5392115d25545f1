"""``lidarena completion SHELL``: a script that lets a shell complete commands, options and names, by shtab."""

import argparse
import sys

from lidarena.base.errors import ConfigError
from lidarena.cli.config_names import Kind, shipped_names

_SHELLS = ("bash", "zsh", "fish", "tcsh")


def complete_names(action: argparse.Action, kind: Kind) -> None:
    """Let a shell complete an argument to the names of the shipped configurations or to files."""
    setattr(action, "complete", {"bash": f"_lidarena_{kind}_names", "zsh": f"_lidarena_{kind}_names"})  # noqa: B010 - shtab's


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's; it is added last, since it knows the program with all its commands."""
    text = 'Print a script for shell completion, such as for eval "$(lidarena completion bash)" in ~/.bashrc.'
    parser = commands.add_parser("completion", help="print a script for shell completion", description=text)
    parser.add_argument("shell", choices=_SHELLS, help="which shell")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the script.

    Raises:
        ConfigError: shtab is not installed.
    """
    try:
        import shtab
    except ImportError:
        raise ConfigError("shell completion needs shtab; install it with pip install 'lidarena[completion]'") from None
    preamble = _NAMES.get(options.shell, "")
    for kind in ("train", "compare"):
        preamble = preamble.replace(kind.upper(), " ".join(shipped_names(kind)))
    sys.stdout.write(shtab.complete(options.program, options.shell, preamble=preamble))
    return 0


_NAMES = {
    "bash": """
_lidarena_train_names() { compgen -W "TRAIN" -- "$1"; compgen -f -X '!*.yaml' -- "$1"; compgen -d -- "$1"; }
_lidarena_compare_names() { compgen -W "COMPARE" -- "$1"; compgen -f -X '!*.yaml' -- "$1"; compgen -d -- "$1"; }
""",
    "zsh": """
_lidarena_train_names() { compadd TRAIN; _files -g '*.yaml'; }
_lidarena_compare_names() { compadd COMPARE; _files -g '*.yaml'; }
""",
}
"""Functions that give the names of configurations, where a shell has such."""
