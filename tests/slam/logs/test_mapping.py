"""Recorded logs mapped by a graph of poses."""

from dataclasses import replace

import numpy as np

from lidarena.slam.logs.mapping import map_log
from lidarena.slam.planar import between, compose
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

TRUTH = way(LAP)
LOG = record(ring(), TRUTH, drift=1.0)


def test_every_reading_has_a_pose_that_fits_the_truth() -> None:
    told = []
    result = map_log(LOG, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (len(LOG.scan_readings),) * 2
    assert result.trajectory.poses.shape == (len(LOG.times), 3)
    scans, truth = result.trajectory.poses[LOG.scan_readings], TRUTH[LOG.scan_readings]
    error = between(between(truth[0], truth), between(scans[0], scans))
    assert np.hypot(error[:, 0], error[:, 1]).mean() < 0.02 and np.degrees(np.abs(error[:, 2]).mean()) < 0.3
    assert result.poses.shape == (len(result.readings), 3)
    assert np.isin(result.readings, LOG.scan_readings).all()
    assert (result.map.occupancy == 100).sum() > 100


def test_a_jump_of_the_odometry_is_bridged() -> None:
    jump = len(LOG.times) // 2
    odometry, unsure = LOG.odometry.copy(), np.zeros(len(LOG.times), np.bool_)
    odometry[jump:] = compose(odometry[jump - 1], between(odometry[jump], odometry[jump:]))
    unsure[jump] = True
    result = map_log(replace(LOG, odometry=odometry, unsure=unsure))
    scans, truth = result.trajectory.poses[LOG.scan_readings], TRUTH[LOG.scan_readings]
    error = between(between(truth[0], truth), between(scans[0], scans))
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.1 and not result.doubts
