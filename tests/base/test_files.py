import os
import platform
from pathlib import Path

import pytest

from lidarena.base import files as atomic_files
from lidarena.base.errors import WriteError


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


def test_what_a_killed_process_left_is_removed_and_what_a_running_one_writes_is_not(tmp_path: Path) -> None:
    dead, alive = f".a.{platform.node()}-999999999.part", f".a.{platform.node()}-1.part"
    for name in (dead, alive, ".a.elsewhere-999999999.part", ".ab.x-999999999.part"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "half").write_text("half")
    atomic_files.write_folder(tmp_path / "a", lambda folder: None)
    left = {path.name for path in tmp_path.iterdir()}
    assert left == {"a", alive, ".a.elsewhere-999999999.part", ".ab.x-999999999.part"}
    (tmp_path / f".b.{platform.node()}-999999999.part").write_text("half")
    atomic_files.write_text(tmp_path / "b", "whole")
    assert {path.name for path in tmp_path.iterdir()} == left | {"b"}


@pytest.mark.parametrize("where", ["file", "file/deeper", "file/deeper/still"])
def test_a_place_in_a_file_is_refused_before_and_while_writing(where: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    target = tmp_path / where / "out"
    with pytest.raises(WriteError, match=r"out' cannot be written: '.*file' is no folder"):
        atomic_files.check_writable(target)
    for write in (
        lambda: atomic_files.write_text(target, ""),
        lambda: atomic_files.replace_folder(target, lambda _: None),
    ):
        with pytest.raises(WriteError) as caught:
            write()
        sentence = f"{str(target)!r} cannot be written: "
        assert str(caught.value) in (sentence + "Not a directory", sentence + "File exists")


def test_a_folder_that_is_not_writable_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != tmp_path)
    with pytest.raises(WriteError, match=rf"the folder '{tmp_path}' is not writable"):
        atomic_files.check_writable(tmp_path / "new" / "out")
    monkeypatch.undo()
    atomic_files.check_writable(tmp_path / "new" / "out")
    assert not list(tmp_path.iterdir())


def test_an_error_that_is_not_about_writing_stays_what_it_is(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"lost\.yaml"):
        atomic_files.write_folder(tmp_path / "a", lambda folder: (tmp_path / "lost.yaml").read_text())  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


def test_a_full_disk_within_a_folder_is_reported_with_the_folder(tmp_path: Path) -> None:
    def fill(folder: Path) -> None:
        raise OSError(28, "No space left on device", str(folder / "map.png"))

    with pytest.raises(WriteError, match=rf"^'{tmp_path / 'a'}' cannot be written: No space left on device$"):
        atomic_files.replace_folder(tmp_path / "a", fill)
    with pytest.raises(WriteError, match=rf"^'{tmp_path / 'a'}' cannot be written: File name too long$"):
        atomic_files.replace_folder(tmp_path / "a", lambda folder: atomic_files.write_text(folder / ("b" * 300), ""))  # type: ignore[arg-type]


def test_a_figure_is_written_whole(tmp_path: Path) -> None:
    from matplotlib.figure import Figure

    path = atomic_files.write_figure(tmp_path / "new" / "a.png", Figure())
    assert path.read_bytes().startswith(b"\x89PNG") and len(list(path.parent.iterdir())) == 1


def test_an_empty_folder_is_not_kept(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    assert atomic_files.set_aside(tmp_path / "empty") is None
    assert atomic_files.set_aside(tmp_path / "missing") is None
    assert not list(tmp_path.iterdir())
