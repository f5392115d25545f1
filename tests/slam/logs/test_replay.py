import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from lidarena.slam.__main__ import main
from lidarena.slam.logs import replay as replay_module
from lidarena.slam.logs.carmen import LogError, RecordedLog, read_log, save_log
from lidarena.slam.logs.relations import Relations, read_relations, relation_errors
from lidarena.slam.logs.replay import ReplayParameters, replay
from lidarena.slam.logs.replay_files import FILES, save_replay
from lidarena.slam.logs.trajectory import load_tum
from lidarena.slam.planar import between, compose, inverse
from lidarena.world.load import load_floorplan
from lidarena.world.map_server import load_map
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, relations_of, way
from tests.world.shared_data import DATA

INTEL = DATA / "logs" / "intel.log.gz"
TRUTH = way(LAP)
LOG = record(ring(), TRUTH)
RELATIONS = relations_of(LOG, TRUTH)
RESULT = replay(LOG)


def save_relations(file: Path, relations: Relations) -> Path:
    rows = [(*t, m[0], m[1], 0, 0, 0, m[2]) for t, m in zip(relations.times, relations.motions, strict=True)]
    np.savetxt(file, rows, fmt="%.6f")
    return file


def test_a_drifting_robot_finds_its_way_round_a_ring() -> None:
    wheels = relation_errors(LOG.times, LOG.odometry, RELATIONS)
    errors = relation_errors(RESULT.trajectory.times, RESULT.trajectory.poses, RELATIONS)
    assert errors.translation.mean() < 0.1
    assert errors.translation.mean() < 0.2 * wheels.translation.mean()
    assert np.array_equal(RESULT.trajectory.times, LOG.times)
    assert set(RESULT.readings) <= set(LOG.scan_readings)


def test_the_map_is_the_ring() -> None:
    grid = RESULT.map
    at = np.floor((TRUTH[:, 1::-1] - grid.origin[1::-1]) / grid.resolution).astype(int)
    assert (grid.occupancy[at[:, 0], at[:, 1]] == 0).mean() > 0.99
    assert np.allclose(np.array(grid.occupancy.shape) * grid.resolution, 8.0, atol=0.5)
    assert grid.occupancy[grid.occupancy.shape[0] // 2, grid.occupancy.shape[1] // 2] == -1


def test_same_seed_same_bits_and_another_seed_another_trajectory() -> None:
    again, other = replay(LOG), replay(LOG, seed=1)
    assert np.array_equal(again.trajectory.poses, RESULT.trajectory.poses)
    assert np.array_equal(again.map.occupancy, RESULT.map.occupancy)
    assert not np.array_equal(other.trajectory.poses, RESULT.trajectory.poses)


def test_wheels_that_err_in_the_same_way_all_along_are_calibrated() -> None:
    wheels = between(LOG.odometry[:-1], LOG.odometry[1:]) * (1.05, 1.05, 1.0)
    biased = [LOG.odometry[0]]
    for step in wheels:
        biased.append(compose(biased[-1], step))
    result = replay(replace(LOG, odometry=np.array(biased)))
    assert result.calibration.scale == pytest.approx(RESULT.calibration.scale / 1.05, abs=0.02)
    assert replay(LOG, parameters=ReplayParameters(calibrate=False)).calibration == (1.0, 1.0, 0.0)


def test_where_the_laser_sits_does_not_matter() -> None:
    mount = np.array([0.2, 0.0, 0.3])
    log = replace(LOG, odometry=compose(LOG.odometry, np.broadcast_to(inverse(mount), LOG.odometry.shape)), mount=mount)
    result = replay(log)
    lasers = compose(result.trajectory.poses, np.broadcast_to(mount, log.odometry.shape))
    assert relation_errors(log.times, lasers, RELATIONS).translation.mean() < 0.1


def test_the_grid_grows_with_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replay_module, "_GROWTH", 0.5)
    result = replay(LOG, parameters=ReplayParameters(usable_range=3.0))
    assert relation_errors(LOG.times, result.trajectory.poses, RELATIONS).translation.mean() < 0.3


def test_a_log_of_one_scan_and_a_log_without_returns_are_replayed() -> None:
    one = replay(replace(LOG, scan_readings=LOG.scan_readings[3:4], ranges=LOG.ranges[3:4]))
    assert len(one.readings) == 1
    assert (one.map.occupancy >= 0).any()
    blind = replay(replace(LOG, ranges=np.full_like(LOG.ranges, LOG.max_range)))
    assert blind.map.occupancy.tolist() == [[-1]]
    assert np.isfinite(blind.trajectory.poses).all()


@pytest.mark.parametrize("wrong", [{"particles": 0}, {"particles": 1001}, {"seed": -1}])
def test_settings_out_of_range_are_refused(wrong: dict[str, int]) -> None:
    with pytest.raises(LogError, match=r"allowed|needed"):
        replay(LOG, **wrong)


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
    assert list(results) == ["translation_m", "rotation_deg", "relations", "scan_updates", "updates_per_second"]
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


def test_without_relations_there_are_no_errors(tmp_path: Path) -> None:
    save_replay(tmp_path / "out", LOG, RESULT)
    results = json.loads((tmp_path / "out" / "results.json").read_text())
    assert results["translation_m"] is results["rotation_deg"] is None
    assert (results["relations"], results["scan_updates"]) == (0, len(RESULT.readings))


def test_the_folder_may_be_the_one_where_one_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    save_replay(".", LOG, RESULT)
    assert (tmp_path / "results.json").exists()


def arguments(tmp_path: Path, log: RecordedLog = LOG) -> list[str]:
    return ["replay", str(save_log(tmp_path / "a.log", log)), "--out", str(tmp_path / "out")]


def test_bad_input_ends_with_one_sentence_and_leaves_what_is_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    good = arguments(tmp_path)
    out = tmp_path / "out"
    save_replay(out, LOG, RESULT)
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


@pytest.mark.skipif(not INTEL.is_file(), reason=f"the Intel log is not at {INTEL}")
def test_the_first_minutes_of_a_real_log_fit_their_relations() -> None:
    whole = read_log(INTEL)
    scans = np.flatnonzero(whole.times[whole.scan_readings] < whole.times[0] + 420)
    readings = int(whole.scan_readings[scans[-1]]) + 1
    log = replace(
        whole,
        times=whole.times[:readings],
        odometry=whole.odometry[:readings],
        scan_readings=whole.scan_readings[scans],
        ranges=whole.ranges[scans],
    )
    relations = read_relations(INTEL.with_name("intel-clean.relations"))
    result = replay(log)
    errors = relation_errors(result.trajectory.times, result.trajectory.poses, relations)
    assert len(errors.translation) > 100
    assert errors.translation.mean() < 0.042
    assert result.updates_per_second > 50  # of a busy machine; some hundreds on a quiet one
