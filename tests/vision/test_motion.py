"""The motion between two pairs: exact without noise, robust, and as certain as it says."""

import numpy as np
import pytest

from lidarena.base.errors import ConfigError, VisionError
from lidarena.vision.motion import OBJECTIVES, MotionOptions, estimate_motion
from lidarena.vision.rigid_motion import inverse, vector_of
from tests.vision.scenes import CAMERA, matches_of, some_motion, stream


def error_of(found: np.ndarray) -> np.ndarray:
    off = some_motion() @ inverse(found)
    return np.r_[vector_of(off[:3, :3]), off[:3, 3]]


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_exact_matches_give_the_exact_motion(objective: str) -> None:
    matches, _ = matches_of(some_motion(), 80, 0.0)
    found = estimate_motion(matches, CAMERA, MotionOptions(objective), stream())
    assert np.abs(error_of(found.motion)).max() < 1e-6 and found.agree.all()


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_wrong_matches_do_not_matter_much(objective: str) -> None:
    matches, right = matches_of(some_motion(), 200, 0.2, wrong=0.4)
    found = estimate_motion(matches, CAMERA, MotionOptions(objective), stream())
    assert np.linalg.norm(error_of(found.motion)[3:]) < 0.05
    assert not (found.agree & ~right).any() and found.agree.sum() > 0.8 * right.sum()


def test_pixels_tell_the_motion_better_than_clouds() -> None:
    off = {objective: [] for objective in OBJECTIVES}  # type: dict[str, list[float]]
    for seed in range(15):
        matches, _ = matches_of(some_motion(), 120, 0.4, seed=seed)
        for objective in OBJECTIVES:
            found = estimate_motion(matches, CAMERA, MotionOptions(objective), stream(seed))
            off[objective].append(float(np.linalg.norm(error_of(found.motion)[3:])))
    assert np.mean(off["reprojection"]) < 0.7 * np.mean(off["clouds"])


def test_the_covariance_is_consistent_and_knows_the_noise() -> None:
    nees, noise = [], []
    for seed in range(60):
        matches, _ = matches_of(some_motion(), 100, 0.4, seed=seed)
        found = estimate_motion(matches, CAMERA, MotionOptions(), stream(seed))
        error = error_of(found.motion)
        nees.append(error @ np.linalg.solve(found.covariance, error))
        noise.append(found.error)
    assert 4.5 < np.mean(nees) < 7.8 and np.mean(noise) == pytest.approx(0.4, rel=0.1)


def test_too_few_matches_are_refused() -> None:
    with pytest.raises(VisionError, match="5 features are matched; a motion needs 6"):
        estimate_motion(matches_of(some_motion(), 5, 0.1)[0], CAMERA, MotionOptions(), stream())
    nonsense, _ = matches_of(some_motion(), 30, 0.0, wrong=1.0)
    nonsense.pixels_b[:] += np.random.default_rng(0).uniform(-90, 90, nonsense.pixels_b.shape)
    with pytest.raises(VisionError, match="features are matched"):
        estimate_motion(nonsense, CAMERA, MotionOptions(), stream())


def test_unknown_objectives_are_refused() -> None:
    with pytest.raises(ConfigError, match="objective = 'cloud' is not known; did you mean 'clouds'"):
        MotionOptions("cloud")
