"""What the tests of the commands share."""

from pathlib import Path

import pytest


@pytest.fixture
def folder_with_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Work in a folder in which ``file.txt`` is no folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file.txt").touch()
