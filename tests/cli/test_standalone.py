"""A subcommand as a program of its own: it parses, runs, and hands the exit code on."""

import argparse

import pytest

from lidarena.cli.standalone import run_alone


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--code", type=int, default=0)
    parser.set_defaults(run=lambda parsed: parsed.code)


def test_the_exit_code_is_the_commands() -> None:
    assert run_alone("Does it.", _add_options, []) == 0
    assert run_alone("Does it.", _add_options, ["--code", "2"]) == 2


def test_help_describes_it(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        run_alone("Does it.", _add_options, ["--help"])
    assert end.value.code == 0 and "Does it." in capsys.readouterr().out
