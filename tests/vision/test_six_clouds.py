"""The 6-cloud fit keeps to H₂ H₁ = H, agrees with what is exact, and is better than a single motion."""

import numpy as np
import pytest

from lidarena.vision.matching import Matches
from lidarena.vision.motion import OBJECTIVES, MotionOptions, estimate_motion
from lidarena.vision.rigid_motion import moved
from lidarena.vision.six_clouds import ThreeViews, fit_six_clouds
from tests.vision.scenes import CAMERA, some_motion, stream


def three_views(noise: float, options: MotionOptions, seed: int = 0, count: int = 80) -> ThreeViews:
    """Everything is seen from all three places, each pixel measured once."""
    rng = np.random.default_rng(seed)
    points = np.column_stack([rng.uniform(-2, 2, count), rng.uniform(-1.2, 1.2, count), rng.uniform(4.0, 6.0, count)])
    h = some_motion()
    pixels = [CAMERA.project(moved(m, points)) for m in (np.eye(4), h, h @ h)]
    pixels = [one + rng.normal(0.0, noise, one.shape) for one in pixels]
    pairs = []
    for a, b in ((0, 1), (1, 2), (0, 2)):
        matches = Matches(np.arange(count), np.arange(count), pixels[a], pixels[b], np.ones(count))
        pairs.append((matches, estimate_motion(matches, CAMERA, options, stream(seed))))
    return ThreeViews(*pairs)


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_exact_views_give_the_exact_motions(objective: str) -> None:
    options = MotionOptions(objective)
    found = fit_six_clouds(three_views(0.0, options), CAMERA, options)
    assert np.allclose(found.near.motion, some_motion(), atol=1e-6)
    assert np.allclose(found.whole.motion, some_motion() @ some_motion(), atol=1e-6)


@pytest.mark.parametrize("objective", OBJECTIVES)
def test_it_is_no_worse_than_single_motions(objective: str) -> None:
    options, alone, joint = MotionOptions(objective), 0.0, 0.0
    for seed in range(12):
        views = three_views(0.4, options, seed)
        found = fit_six_clouds(views, CAMERA, options)
        alone += float(np.linalg.norm(views.near[1].motion[:3, 3] - some_motion()[:3, 3]))
        joint += float(np.linalg.norm(found.near.motion[:3, 3] - some_motion()[:3, 3]))
    assert joint < (0.98 if objective == "clouds" else 0.95) * alone


def test_more_views_make_it_more_certain() -> None:
    options = MotionOptions()
    views = three_views(0.4, options)
    found = fit_six_clouds(views, CAMERA, options)
    assert np.trace(found.near.covariance[3:, 3:]) < np.trace(views.near[1].covariance[3:, 3:])


def test_tracked_features_count_as_one_where_they_begin_at_one() -> None:
    options = MotionOptions()
    views = three_views(0.2, options)
    tracked = ThreeViews(*((m._replace(second=np.full(len(m.first), -1)), e) for m, e in views))
    found = fit_six_clouds(tracked, CAMERA, options)
    assert np.allclose(found.whole.motion, fit_six_clouds(views, CAMERA, options).whole.motion, atol=0.01)
