import numpy as np
import pytest

from lidarena.slam.logs.calibration import OdometryCalibration, calibrated, fit_calibration
from lidarena.slam.planar import between
from tests.slam.logs.recorded import LAP, way


def motions(count: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.column_stack([rng.uniform(0, 0.4, count), rng.normal(0, 0.01, count), rng.normal(0, 0.2, count)])


@pytest.mark.parametrize("seed", range(4))
def test_a_known_bias_is_found_in_spite_of_wrong_matches(seed: int) -> None:
    rng = np.random.default_rng(seed)
    wheels = motions(400, seed)
    true = wheels * (0.95, 0.95, 1.04)
    true[:, 2] += 0.06 * wheels[:, 0]
    matched = true + rng.normal(0, 0.005, true.shape)
    matched[rng.choice(400, 20, replace=False)] += 0.5
    found = fit_calibration(wheels, matched)
    np.testing.assert_allclose(found, (0.95, 1.04, 0.06), atol=0.01)


def test_too_little_and_too_wild_motions_calibrate_nothing() -> None:
    wheels = motions(100, 0)
    assert fit_calibration(wheels[:10], 1.1 * wheels[:10]) == OdometryCalibration()
    assert fit_calibration(wheels, 2.0 * wheels) == OdometryCalibration()
    assert fit_calibration(np.zeros((50, 3)), np.zeros((50, 3))) == OdometryCalibration()


def test_calibrated_steps_are_the_corrected_ones_and_no_calibration_changes_nothing() -> None:
    path = way(LAP)
    np.testing.assert_allclose(calibrated(path, OdometryCalibration())[:, :2], path[:, :2], atol=1e-9)
    bent = calibrated(path, OdometryCalibration(0.9, 1.1, 0.05))
    before, after = between(path[:-1], path[1:]), between(bent[:-1], bent[1:])
    np.testing.assert_allclose(after[:, :2], 0.9 * before[:, :2], atol=1e-9)
    np.testing.assert_allclose(after[:, 2], 1.1 * before[:, 2] + 0.05 * before[:, 0], atol=1e-9)
