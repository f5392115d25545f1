from dataclasses import replace

import numpy as np
import pytest

from lidarena.slam.logs import replay as replay_module
from lidarena.slam.logs.carmen import LogError, read_log
from lidarena.slam.logs.relations import read_relations, relation_errors
from lidarena.slam.logs.replay import ReplayParameters, replay
from lidarena.slam.planar import between, compose, inverse
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, relations_of, way
from tests.world.shared_data import DATA

INTEL = DATA / "logs" / "intel.log.gz"
TRUTH = way(LAP)
LOG = record(ring(), TRUTH)
RELATIONS = relations_of(LOG, TRUTH)
RESULT = replay(LOG)


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
