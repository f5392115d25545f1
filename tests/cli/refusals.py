"""A command that is refused: exit code 2 and one sentence."""

import pytest

from lidarena.cli import main


def assert_refused(arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Run the program; it must end with 2 and one line that holds ``sentence``."""
    assert main(arguments) == 2
    printed = capsys.readouterr()
    assert sentence in printed.err and printed.err.count("\n") == 1
