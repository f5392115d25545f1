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


def test_a_folder_that_is_replaced_is_kept_under_the_next_number(tmp_path: Path) -> None:
    place = tmp_path / "results"
    kept = [atomic_files.replace_folder(place, lambda folder, n=n: (folder / "n").write_text(n)) for n in "abc"]
    assert kept == [None, tmp_path / "results.1", tmp_path / "results.2"]
    assert [(path / "n").read_text() for path in (*kept[1:], place)] == ["a", "b", "c"]


def test_a_folder_stays_where_it_is_if_the_new_one_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = tmp_path / "results"
    atomic_files.replace_folder(place, lambda folder: (folder / "n").write_text("precious"))
    rename = os.replace

    def fail(source: Path, target: Path) -> None:
        if Path(target) == place and Path(source).name.startswith("."):
            raise OSError(28, "No space left on device")
        rename(source, target)

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="No space"):
        atomic_files.replace_folder(place, lambda folder: (folder / "n").write_text("new"))
    assert [path.name for path in tmp_path.iterdir()] == ["results"]
    assert (place / "n").read_text() == "precious"


def test_a_full_disk_is_reported_with_the_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full_disk(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(OSError) as caught:
        atomic_files.write_text(tmp_path / "a.txt", "new")
    assert caught.value.filename == str(tmp_path / "a.txt")


def test_an_empty_folder_is_not_kept(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    assert atomic_files.set_aside(tmp_path / "empty") is None
    assert atomic_files.set_aside(tmp_path / "missing") is None
    assert not list(tmp_path.iterdir())
