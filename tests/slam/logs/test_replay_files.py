import json
from pathlib import Path

import pytest

from lidarena.slam.logs.carmen import LogError
from lidarena.slam.logs.replay import replay
from lidarena.slam.logs.replay_files import FILES, save_replay
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

LOG = record(ring(), way(LAP)[:80])
RESULT = replay(LOG, 4)


def test_without_relations_there_are_no_errors(tmp_path: Path) -> None:
    save_replay(tmp_path / "out", LOG, RESULT)
    results = json.loads((tmp_path / "out" / "results.json").read_text())
    assert results["translation_m"] is results["rotation_deg"] is None
    assert (results["relations"], results["scan_updates"]) == (0, len(RESULT.readings))


def test_the_folder_may_be_the_one_where_one_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    save_replay(".", LOG, RESULT)
    assert (tmp_path / "results.json").exists()


def test_a_folder_with_other_peoples_files_is_refused(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("")
    with pytest.raises(LogError, match=r"holds 'thesis\.tex'"):
        save_replay(tmp_path, LOG, RESULT)
    assert [file.name for file in tmp_path.iterdir()] == ["thesis.tex"]


def test_an_earlier_replay_is_kept_under_the_next_number(tmp_path: Path) -> None:
    assert [save_replay(tmp_path / "out", LOG, RESULT) for _ in range(3)] == [
        None,
        tmp_path / "out.1",
        tmp_path / "out.2",
    ]
    assert all({file.name for file in place.iterdir()} == set(FILES) for place in tmp_path.iterdir())
