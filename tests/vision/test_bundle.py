"""The adjustment finds the least squares that a general solver finds, and tells a covariance that is right."""

import numpy as np
from scipy.optimize import least_squares

from lidarena.vision.bundle import Observations, adjust
from lidarena.vision.motion import two_views
from lidarena.vision.rigid_motion import inverse, motion_of, rotation_of, vector_of
from tests.vision.scenes import CAMERA, matches_of, some_motion


def fit(noise: float, seed: int, count: int = 60) -> tuple:  # type: ignore[type-arg]
    matches, _ = matches_of(some_motion(), count, noise, seed=seed)
    seen = two_views(matches, np.arange(count))
    start = motion_of(np.eye(3), some_motion()[:3, 3] + 0.1)
    points = CAMERA.triangulate(matches.pixels_a)
    return adjust(CAMERA, np.stack([np.eye(4), start]), points, seen, huber=1e6), seen, points


def test_exact_pixels_give_the_exact_motion() -> None:
    fitted, _, _ = fit(0.0, 0)
    assert np.allclose(fitted.poses[1], some_motion(), atol=1e-6) and fitted.errors.max() < 1e-4
    assert np.array_equal(fitted.poses[0], np.eye(4))


def test_it_is_the_minimum_that_scipy_finds() -> None:
    fitted, seen, points = fit(0.7, 1, 12)

    def residuals(x: np.ndarray) -> np.ndarray:
        pose = motion_of(rotation_of(x[:3]), x[3:6])
        where = x[6:].reshape(-1, 3)
        pixels = [CAMERA.project(where), CAMERA.project(where @ pose[:3, :3].T + pose[:3, 3])]
        return np.concatenate([seen.pixels[0::2] - pixels[0], seen.pixels[1::2] - pixels[1]]).ravel()

    start = np.r_[vector_of(some_motion()[:3, :3]), some_motion()[:3, 3], points.ravel()]
    best = least_squares(residuals, start, x_scale="jac", xtol=1e-14, ftol=1e-14)
    own = np.r_[vector_of(fitted.poses[1][:3, :3]), fitted.poses[1][:3, 3], fitted.points.ravel()]
    assert np.isclose(np.square(residuals(own)).sum(), 2.0 * best.cost, rtol=1e-6)
    assert np.allclose(fitted.poses[1][:3, 3], best.x[3:6], atol=1e-4)


def test_the_covariance_is_that_of_the_errors() -> None:
    """NEES: the mean of e' C^-1 e over 120 fits is 6 +- 0.3 (one deviation) if the covariance is right."""
    nees = []
    for seed in range(120):
        fitted, _, _ = fit(0.5, seed)
        off = some_motion() @ inverse(fitted.poses[1])
        error = np.r_[vector_of(off[:3, :3]), off[:3, 3]]
        nees.append(error @ np.linalg.solve(0.25 * fitted.covariance, error))
    assert 5.0 < np.mean(nees) < 7.2


def test_hubers_loss_holds_a_wrong_match_off() -> None:
    matches, _ = matches_of(some_motion(), 60, 0.2)
    matches.pixels_b[3] += (25.0, 0.0, 25.0, 0.0)
    seen, points = two_views(matches, np.arange(60)), CAMERA.triangulate(matches.pixels_a)
    start = np.stack([np.eye(4), some_motion()])
    robust, plain = (adjust(CAMERA, start, points, seen, huber=huber) for huber in (1.5, 1e6))
    off = [np.abs(one.poses[1] - some_motion()).max() for one in (robust, plain)]
    assert off[0] < 0.4 * off[1]


def test_three_views_are_fitted_together_and_fixed_ones_stay() -> None:
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.uniform(-2, 2, 40), rng.uniform(-1, 1, 40), rng.uniform(4, 6, 40)])
    poses = np.stack([np.eye(4), some_motion(), some_motion() @ some_motion()])
    pixels = np.stack([CAMERA.project(points @ p[:3, :3].T + p[:3, 3]) for p in poses], axis=1).reshape(-1, 4)
    frame = np.tile([0, 1, 2], 40)
    seen = Observations(3 * np.arange(41), frame, pixels, np.full((120, 2), 0.3))
    begun = poses.copy()
    begun[2, :3, 3] += 0.05
    fitted = adjust(CAMERA, begun, points + 0.02, seen, fixed=2)
    assert np.array_equal(fitted.poses[:2], poses[:2]) and np.allclose(fitted.poses[2], poses[2], atol=1e-6)
    assert fitted.covariance.shape == (6, 6)
