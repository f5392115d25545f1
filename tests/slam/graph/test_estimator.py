"""The graph of poses as an environment's estimator: it finds its way, tells how surely, and can be saved."""

import numpy as np
import pytest

from lidarena.base.errors import ConfigError, EstimatorError
from lidarena.slam.estimator import MapGrid, ScanSpec
from lidarena.slam.graph.estimator import GraphEstimator
from lidarena.slam.planar import between
from lidarena.slam.registry import make_estimator
from lidarena.slam.uncertainty import COVARIANCE_FLOOR
from lidarena.slam.world_estimators import WorldEstimators
from tests.slam.drive import ring
from tests.slam.estimator_cases import settings_for
from tests.slam.logs.recorded import LAP, RANGE, record, way

TRUTH = way(LAP)
LOG = record(ring(), TRUTH, drift=2.0)
SPEC = ScanSpec(LOG.angles, RANGE, 0.01)
GRID = MapGrid(np.array([-1.0, -1.0]), 0.05, (200, 200))
MOTIONS = between(LOG.odometry[np.maximum(np.arange(len(TRUTH)) - 1, 0)], LOG.odometry)
SCANS = np.zeros((len(TRUTH), len(LOG.angles)), np.float32)
SCANS[LOG.scan_readings] = LOG.ranges


def begun() -> GraphEstimator:
    estimator = GraphEstimator(SPEC)
    estimator.reset(TRUTH[0], GRID)
    return estimator


def drive(estimator: GraphEstimator, first: int, last: int) -> np.ndarray:
    """Poses and covariances (n, 12) after each step."""
    rows = []
    for k in range(first, last):
        estimator.update(MOTIONS[k], SCANS[k], 0.1 * k)
        rows.append(np.concatenate([estimator.pose, estimator.covariance.ravel()]))
    return np.array(rows)


@pytest.fixture(scope="module")
def whole() -> tuple[GraphEstimator, np.ndarray]:
    estimator = begun()
    return estimator, drive(estimator, 0, len(TRUTH))


def test_it_finds_its_way_round_a_ring(whole: tuple[GraphEstimator, np.ndarray]) -> None:
    rows = whole[1]
    away = np.hypot(*(rows[:, :2] - TRUTH[:, :2]).T)
    by_wheels = np.hypot(*(LOG.odometry[:, :2] - TRUTH[:, :2]).T)
    assert away.mean() < 0.04 and away.max() < 0.12
    assert by_wheels.max() > 4.0 * away.max()


def test_its_covariance_is_one_and_grows_with_the_way(whole: tuple[GraphEstimator, np.ndarray]) -> None:
    covariances = whole[1][:, 3:].reshape(-1, 3, 3)
    np.testing.assert_allclose(covariances, covariances.transpose(0, 2, 1), atol=1e-12)
    eigenvalues = np.linalg.eigvalsh(covariances + np.diag(COVARIANCE_FLOOR))
    assert (eigenvalues > 0.0).all()
    deviations = np.sqrt(covariances[:, 0, 0] + covariances[:, 1, 1])
    assert deviations[0] < 0.002
    assert deviations[len(TRUTH) // 2] > 2.0 * deviations[0]
    assert deviations.max() < 0.1


def test_its_map_shows_the_walls_where_they_are(whole: tuple[GraphEstimator, np.ndarray]) -> None:
    cells = whole[0].map
    assert set(np.unique(cells)) <= {-1, 0, 100}
    rows, columns = np.nonzero(cells == 100)
    centres = GRID.origin + (np.stack([columns, rows], axis=1) + 0.5) * GRID.resolution
    away = np.abs(ring().clearance(centres))
    assert np.mean(away < 0.08) > 0.9
    rows, columns = np.nonzero(cells == 0)
    centres = GRID.origin + (np.stack([columns, rows], axis=1) + 0.5) * GRID.resolution
    assert np.mean(ring().clearance(centres) > -0.05) > 0.97


def test_what_is_saved_goes_on_to_the_bit(whole: tuple[GraphEstimator, np.ndarray]) -> None:
    middle = len(TRUTH) // 3
    first = begun()
    drive(first, 0, middle)
    second = begun()
    second.set_state(first.get_state())
    np.testing.assert_array_equal(drive(second, middle, middle + 20), whole[1][middle : middle + 20])
    second.reset(TRUTH[0], GRID)
    np.testing.assert_array_equal(drive(second, 0, 20), whole[1][:20])


def test_it_is_an_estimator_by_name_and_checks_what_it_is_made_of() -> None:
    assert isinstance(make_estimator("graph", settings_for(2)), WorldEstimators)
    with pytest.raises(ConfigError, match="adjust_every"):
        make_estimator({"name": "graph", "adjust_every": 0}, settings_for(1))
    with pytest.raises(EstimatorError, match="evenly spaced beams"):
        GraphEstimator(ScanSpec(np.array([0.0, 0.1, 0.5]), 3.5, 0.01))
