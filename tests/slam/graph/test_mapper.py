"""The mapper as a robot's program uses it."""

import numpy as np
import pytest

from lidarena.base.errors import ConfigError, EstimatorError
from lidarena.slam.graph.mapper import MapParameters, Mapper
from lidarena.slam.planar import between
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

TRUTH = way(LAP)
LOG = record(ring(), TRUTH, drift=3.0)


def mapped() -> Mapper:
    mapper = Mapper(LOG.angles, LOG.max_range)
    for k, reading in enumerate(LOG.scan_readings):
        mapper.add(LOG.times[reading], LOG.odometry[reading], LOG.ranges[k])
    return mapper


def test_it_knows_where_it_is_and_where_it_was() -> None:
    mapper = mapped()
    truth = TRUTH[LOG.scan_readings]
    assert np.abs(between(truth[-1], mapper.pose)).max() < 0.1
    poses = mapper.finish().poses
    error = between(truth, poses)
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.05
    assert np.abs(error[:, 2]).max() < 0.02


def test_the_same_scans_give_the_same_bits() -> None:
    first, second = mapped().finish(), mapped().finish()
    np.testing.assert_array_equal(first.poses, second.poses)


@pytest.mark.parametrize("angles", [np.array([0.0]), np.array([0.0, 0.1, 0.5]), np.zeros(4)])
def test_beams_must_be_evenly_spaced(angles: np.ndarray) -> None:
    with pytest.raises(EstimatorError, match="evenly spaced"):
        Mapper(angles, 10.0)


def test_readings_must_be_whole() -> None:
    mapper = Mapper(LOG.angles, LOG.max_range)
    with pytest.raises(EstimatorError, match=r"shape \(7,\); \(180,\) is needed"):
        mapper.add(0.0, np.zeros(3), np.ones(7, np.float32))
    with pytest.raises(EstimatorError, match="three finite numbers"):
        mapper.add(0.0, np.array([0.0, np.nan, 0.0]), LOG.ranges[0])
    assert mapper.front.count == 0


def test_scans_without_returns_follow_the_wheels() -> None:
    mapper = Mapper(LOG.angles, LOG.max_range)
    ranges = [0.0, np.inf, np.nan, -1.0, 1e9]
    for k in range(5):
        pose = mapper.add(0.1 * k, np.array([0.1 * k, 0.0, 0.0]), np.full(180, ranges[k], np.float32))
    np.testing.assert_allclose(pose, [0.4, 0.0, 0.0])
    assert len(mapper.finish().poses) == 5


def test_places_are_known_after_one_visit_at_the_earliest() -> None:
    with pytest.raises(ConfigError, match="visits"):
        MapParameters(visits=0)
