"""The command writes everything at once, keeps what was there, and refuses bad input in one sentence."""

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from lidarena.slam.__main__ import main
from lidarena.slam.logs.carmen import RecordedLog, save_log
from lidarena.slam.logs.relations import Relations, read_relations, relation_errors
from lidarena.slam.logs.replay_files import FILES
from lidarena.slam.logs.trajectory import load_tum
from lidarena.world.load import load_floorplan
from lidarena.world.map_server import load_map
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, relations_of, way

KEYS = [
    "translation_m",
    "rotation_deg",
    "relations",
    "scan_updates",
    "updates_per_second",
    "evidence_of_attempts",
    "spread_of_attempts_m",
]
TRUTH = way(LAP)
LOG = record(ring(), TRUTH)
RELATIONS = relations_of(LOG, TRUTH)


def save_relations(file: Path, relations: Relations) -> Path:
    rows = [(*t, m[0], m[1], 0, 0, 0, m[2]) for t, m in zip(relations.times, relations.motions, strict=True)]
    np.savetxt(file, rows, fmt="%.6f")
    return file


def test_the_command_writes_everything_and_keeps_what_was_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log, relations = save_log(tmp_path / "a.log.gz", LOG), save_relations(tmp_path / "a.relations", RELATIONS)
    out = tmp_path / "deep" / "out"
    for _ in range(2):
        assert main(["replay", str(log), "--relations", str(relations), "--out", str(out), "--particles", "8"]) == 0
    assert sorted(p.name for p in out.iterdir()) == sorted(p.name for p in (out.parent / "out.1").iterdir())
    assert sorted(p.name for p in out.iterdir()) == sorted(FILES)
    assert sorted(p.name for p in out.parent.iterdir()) == ["out", "out.1"]
    results = json.loads((out / "results.json").read_text())
    assert list(results) == KEYS
    trajectory = load_tum(out / "trajectory.tum")
    errors = relation_errors(trajectory.times, trajectory.poses, read_relations(relations))
    assert results["translation_m"]["mean"] == pytest.approx(errors.translation.mean(), abs=1e-4)
    assert results["translation_m"]["std"] == pytest.approx(errors.translation.std(), abs=1e-4)
    assert results["rotation_deg"]["mean"] == pytest.approx(np.degrees(errors.rotation.mean()), abs=0.01)
    assert results["relations"] == len(errors.translation)
    assert load_map(out / "map.yaml").resolution == 0.05
    assert load_floorplan(str(out / "map.yaml")).edges.size
    assert cv2.imread(str(out / "picture.png")).std() > 10
    said = capsys.readouterr()
    assert "60 relations: translation 0.0" in said.out
    assert "the replay that stood there is now in" in said.out


def arguments(tmp_path: Path, log: RecordedLog = LOG) -> list[str]:
    return ["replay", str(save_log(tmp_path / "a.log", log)), "--out", str(tmp_path / "out")]


def test_bad_input_ends_with_one_sentence_and_leaves_what_is_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    good = arguments(tmp_path)
    out = tmp_path / "out"
    assert main(good) == 0
    capsys.readouterr()
    before = {p.name: p.read_bytes() for p in out.iterdir()}
    torn, empty = tmp_path / "torn.log", tmp_path / "empty.log"
    torn.write_text((tmp_path / "a.log").read_text()[:-60])
    empty.write_text("")
    others = save_relations(tmp_path / "others", replace(RELATIONS, times=RELATIONS.times + 1e6))
    cases = [
        ["replay", str(torn), *good[2:]],
        ["replay", str(empty), *good[2:]],
        ["replay", str(tmp_path / "none.log"), *good[2:]],
        [*good, "--relations", str(others)],
        [*good, "--relations", str(torn)],
        [*good, "--particles", "0"],
        [*good[:2], "--out", str(tmp_path)],
        [*good[:2], "--out", str(torn)],
    ]
    for case in cases:
        assert main(case) == 2
        said = capsys.readouterr().err.strip().splitlines()
        assert len([line for line in said if "scans " not in line]) == 1, said
    assert {p.name: p.read_bytes() for p in out.iterdir()} == before


def test_torn_lines_are_skipped_if_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    short = replace(
        LOG, times=LOG.times[:9], odometry=LOG.odometry[:9], scan_readings=LOG.scan_readings[:5], ranges=LOG.ranges[:5]
    )
    command = arguments(tmp_path, short)
    file = Path(command[1])
    file.write_text(file.read_text() + "FLASER 180 1.0 1.0\n")
    assert main([*command, "--skip-torn"]) == 0
    assert "1 torn lines skipped" in capsys.readouterr().out


def test_a_place_that_cannot_be_written_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    short = replace(LOG, scan_readings=LOG.scan_readings[:5], ranges=LOG.ranges[:5])
    assert main([*arguments(tmp_path, short)[:2], "--out", str(tmp_path / "file" / "out")]) == 2
    assert "cannot be written" in capsys.readouterr().err
