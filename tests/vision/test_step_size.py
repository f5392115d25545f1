"""The adaptive step is Bobkov et al.'s formula, and overlaps are those of the geometry."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.base.errors import ConfigError
from lidarena.vision.rigid_motion import moved
from lidarena.vision.step_size import adaptive_step, common_view, nearest_depth, view_overlap
from tests.vision.scenes import CAMERA, some_motion


def ahead(metres: float) -> np.ndarray:
    motion = np.eye(4)
    motion[1, 3] = metres  # the ground moves down in the image
    return motion


def test_the_step_of_a_worked_example() -> None:
    """5 m above the ground the footprint is 5 · 400 / 519.6 = 3.849 m; a quarter of it at 0.5 m/s are 48.1 frames."""
    assert adaptive_step(CAMERA, 5.0, 0.5, 25.0, 0.75) == 48
    assert adaptive_step(CAMERA, 5.0, 0.5, 25.0, 0.5) == 96
    assert adaptive_step(CAMERA, 0.1, 5.0, 25.0, 0.75) == 1


@given(st.floats(0.5, 20), st.floats(0.05, 3), st.floats(0.1, 0.95))
def test_the_step_keeps_the_overlap(height: float, speed: float, overlap: float) -> None:
    step = adaptive_step(CAMERA, height, speed, 25.0, overlap)
    if step > 1:
        assert view_overlap(CAMERA, ahead(step * speed / 25.0), height) >= overlap - 0.12
        assert step <= (1 - overlap) * height * 400 / CAMERA.focal * 25.0 / speed


def test_the_overlap_is_all_at_rest_and_nothing_far_away() -> None:
    assert view_overlap(CAMERA, np.eye(4), 5.0) == 1.0 and view_overlap(CAMERA, ahead(9.0), 5.0) == 0.0


def test_the_nearest_depth_leaves_out_what_is_wrong() -> None:
    points = np.column_stack(
        [np.zeros(200), np.zeros(200), np.r_[np.full(3, 0.4), np.full(2, np.nan), np.full(195, 5.0)]]
    )
    assert nearest_depth(points) == 5.0 and np.isnan(nearest_depth(np.full((2, 3), np.nan)))


def test_clipping_keeps_all_that_both_see() -> None:
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.uniform(-4, 4, 900), rng.uniform(-3, 3, 900), rng.uniform(4.0, 6.0, 900)])
    one, two = CAMERA.project(points), CAMERA.project(moved(some_motion(), points))
    inside = [(p[:, 0] >= 0) & (p[:, 0] < 600) & (p[:, 1] >= 0) & (p[:, 1] < 400) for p in (one, two)]
    both = inside[0] & inside[1]
    regions = common_view(CAMERA, some_motion(), (4.0, 6.0))
    assert regions is not None and both.sum() > 100
    for pixels, (left, top, right, bottom) in zip((one, two), regions, strict=True):
        kept = (pixels[:, 0] >= left) & (pixels[:, 0] < right) & (pixels[:, 1] >= top) & (pixels[:, 1] < bottom)
        assert kept[both].all() and (right - left) * (bottom - top) < 0.97 * 600 * 400


def test_views_that_have_nothing_in_common_have_no_region() -> None:
    assert common_view(CAMERA, ahead(9.0), (4.0, 5.0)) is None


def test_an_overlap_of_more_than_all_is_refused() -> None:
    with pytest.raises(ConfigError, match="overlap"):
        adaptive_step(CAMERA, 5.0, 0.5, 25.0, 1.5)
