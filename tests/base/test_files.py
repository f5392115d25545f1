import os
from pathlib import Path

import pytest

from lidarena.base import files as atomic_files


def test_an_interrupted_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = atomic_files.write_text(tmp_path / "deep" / "a.txt", "old")

    def full_disk(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full_disk)
    with pytest.raises(OSError, match="No space"):
        atomic_files.write_text(file, "new")
    assert file.read_text() == "old"
    assert list(file.parent.iterdir()) == [file]


def test_a_folder_appears_whole_or_not_at_all(tmp_path: Path) -> None:
    def fill(folder: Path) -> None:
        assert not (tmp_path / "a").exists()
        (folder / "one").write_text("1")

    atomic_files.write_folder(tmp_path / "a", fill)
    assert (tmp_path / "a" / "one").read_text() == "1"

    def fail(folder: Path) -> None:
        (folder / "one").write_text("1")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        atomic_files.write_folder(tmp_path / "b", fail)
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_folder_that_is_there_is_not_replaced(tmp_path: Path) -> None:
    with pytest.raises(FileExistsError):
        atomic_files.write_folder(tmp_path, lambda folder: None)
