from pathlib import Path

import pytest

from lidarena.base.errors import WriteError
from lidarena.slam.logs.recorded_log import LogError
from lidarena.slam.logs.results_folder import check_folder, replace_results

FILES = ("map.pgm", "results.json")


def test_a_folder_with_other_peoples_files_is_refused(tmp_path: Path) -> None:
    check_folder(tmp_path / "new", FILES)
    check_folder(tmp_path, FILES)
    for name in FILES:
        (tmp_path / name).write_text("")
    check_folder(tmp_path, FILES)
    (tmp_path / "thesis.tex").write_text("")
    with pytest.raises(LogError, match=r"holds 'thesis\.tex'; an empty or new one"):
        check_folder(tmp_path, FILES)
    with pytest.raises(LogError, match="is a file; a folder is needed"):
        check_folder(tmp_path / "thesis.tex", FILES)


def test_earlier_results_move_aside(tmp_path: Path) -> None:
    def write(text: str) -> Path | None:
        return replace_results(
            tmp_path / "out", FILES, lambda folder: [(folder / n).write_text(text) for n in FILES][:0]
        )

    assert [write(text) for text in "abc"] == [None, tmp_path / "out.1", tmp_path / "out.2"]
    assert [(tmp_path / name / FILES[0]).read_text() for name in ("out.1", "out.2", "out")] == ["a", "b", "c"]


def test_what_was_there_stays_where_writing_fails(tmp_path: Path) -> None:
    def fails(folder: Path) -> None:
        (folder / FILES[0]).write_text("half")
        raise WriteError("the disk is full")

    (tmp_path / "out").mkdir()
    (tmp_path / "out" / FILES[1]).write_text("earlier")
    with pytest.raises(WriteError, match="full"):
        replace_results(tmp_path / "out", FILES, fails)
    assert [(path.name, path.read_text()) for path in (tmp_path / "out").iterdir()] == [(FILES[1], "earlier")]
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
