"""Projection and triangulation are each other's inverse, and pairs that do not fit are refused."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.base.errors import ConfigError, VisionError
from lidarena.vision.camera import StereoCamera
from tests.vision.scenes import CAMERA


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(0.5, 30))
def test_what_is_projected_is_triangulated_where_it_was(x: float, y: float, z: float) -> None:
    point = np.array([[x, y, z]])
    pixels = CAMERA.project(point)
    assert np.allclose(CAMERA.triangulate(pixels), point, atol=1e-8)
    assert CAMERA.epipolar_errors(pixels)[0] == 0.0 and pixels[0, 0] > pixels[0, 2]


def test_the_field_of_view_ends_at_the_border() -> None:
    edge = 5.0 * math.tan(math.radians(30.0))
    pixels = CAMERA.project(np.array([[edge, 0.0, 5.0], [0.0, 0.0, 5.0]]))
    assert np.isclose(pixels[0, 0], 599.5) and np.allclose(pixels[1, :2], [299.5, 199.5])


def test_what_is_behind_or_without_disparity_is_nan() -> None:
    assert np.isnan(CAMERA.project(np.array([[0.0, 0.0, -1.0]]))).all()
    assert np.isnan(CAMERA.triangulate(np.array([[10.0, 5.0, 10.0, 5.0], [10.0, 5.0, 12.0, 5.0]]))).all()


def test_disparity_is_focal_length_times_baseline_over_depth() -> None:
    pixels = CAMERA.project(np.array([[0.3, 0.2, 4.0]]))
    assert np.isclose(pixels[0, 0] - pixels[0, 2], CAMERA.focal * 0.4 / 4.0)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"focal": 0.0}, "focal = 0.0"),
        ({"baseline": -0.4}, "baseline = -0.4"),
        ({"width": 3}, "width = 3"),
        ({"height": 400.5}, "height = 400.5"),
        ({"center_x": 900.0}, "center_x = 900.0"),
    ],
)
def test_a_camera_that_cannot_be_is_refused(change: dict[str, float], words: str) -> None:
    fine = {"focal": 500.0, "center_x": 300.0, "center_y": 200.0, "baseline": 0.4, "width": 600, "height": 400}
    with pytest.raises(ConfigError, match=words):
        StereoCamera(**fine | change)  # type: ignore[arg-type]


def test_images_that_do_not_fit_are_refused() -> None:
    fine = np.zeros((400, 600), np.uint8)
    CAMERA.check_pair(fine, fine)
    with pytest.raises(VisionError, match="of two sizes, 600 x 400 and 300 x 400"):
        CAMERA.check_pair(fine, fine[:, :300])
    with pytest.raises(VisionError, match="frame 7 have 300 x 400 pixels, the calibration is for 600 x 400"):
        CAMERA.check_pair(fine[:, :300], fine[:, :300], "frame 7")
    with pytest.raises(VisionError, match="right image of the pair is float64"):
        CAMERA.check_pair(fine, fine.astype(float))
