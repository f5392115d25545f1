"""Pictures show what the geometry says: disparity, motion, brightness; and no camera is below the seabed."""

import math

import numpy as np
import pytest

from lidarena.base.errors import VisionError
from lidarena.vision.features import track
from lidarena.vision.rigid_motion import inverse, moved
from lidarena.vision.seabed import make_seabed
from lidarena.vision.seabed_renderer import _first_hit, downward_pose, render_pair
from lidarena.vision.water import CLEAR, Water
from tests.vision.scenes import CAMERA, pair_at, pose_at, seabed, stream


def ground_below(pixels: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Points (N, 3) in the world that left pixels (N, 2) show, by bisection instead of Newton's method."""
    rays = np.column_stack([(pixels - (CAMERA.center_x, CAMERA.center_y)) / CAMERA.focal, np.ones(len(pixels))])
    points = []
    for ray in rays @ pose[:3, :3].T:
        low, high = 0.0, 30.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            x, y, z = pose[:3, 3] + middle * ray
            low, high = (middle, high) if z > seabed().height(x, y) else (low, middle)
        points.append(pose[:3, 3] + low * ray)
    return np.array(points)


def test_the_right_and_the_next_picture_show_the_same_points_where_they_are() -> None:
    a, b = pose_at(8.0), pose_at(8.4, heading=0.13)
    pair, later = pair_at(8.0, CLEAR), render_pair(seabed(), CAMERA, b, CLEAR, stream())
    rng = np.random.default_rng(3)
    pixels = np.rint(np.column_stack([rng.uniform(120, 560, 60), rng.uniform(120, 360, 60)]))
    world = ground_below(pixels, a)
    for image, expected in (
        (pair[1], CAMERA.project(moved(inverse(a), world))[:, 2:]),
        (later[0], CAMERA.project(moved(inverse(b), world))[:, :2]),
    ):
        found, fits = track(pair[0], image, pixels.astype(np.float32), expected.astype(np.float32), levels=0)
        off = np.abs(found - expected).max(axis=1)[fits]
        assert fits.mean() > 0.9 and np.median(off) < 0.04 and np.quantile(off, 0.9) < 0.2


def test_the_same_noise_makes_the_same_picture() -> None:
    again = render_pair(seabed(), CAMERA, pose_at(8.0), Water(), stream(80))
    other = render_pair(seabed(), CAMERA, pose_at(8.0), Water(), stream(81))
    assert np.array_equal(again[0], pair_at(8.0)[0]) and np.array_equal(again[1], pair_at(8.0)[1])
    assert not np.array_equal(other[0], again[0])


def test_haze_takes_contrast_and_gives_the_veils_brightness() -> None:
    clear, hazy = pair_at(8.0, CLEAR)[0], pair_at(8.0, Water(haze=0.4, backscatter=90.0, vignetting=0.0, noise=0.0))[0]
    assert clear.std() > 10.0 and hazy.std() < 0.5 * clear.std() and hazy.mean() < clear.mean()


def test_corners_are_darker_by_vignetting_and_pixels_vary_by_noise() -> None:
    plain, dark = pair_at(8.0, CLEAR)[0].astype(float), pair_at(8.0, Water(0.0, 0.0, 0.5, 0.0))[0].astype(float)
    share = dark / np.maximum(plain, 1.0)
    assert share[195:205, 295:305].mean() > 0.97 and share[:8, :8].mean() == pytest.approx(0.5, abs=0.05)
    noisy = pair_at(8.0, Water(0.0, 0.0, 0.0, 3.0))[0].astype(float)
    assert (noisy - plain).std() == pytest.approx(3.0, rel=0.05)


def test_a_downward_pose_has_the_images_top_ahead() -> None:
    pose = downward_pose(1.0, 2.0, 3.0, math.pi / 2)
    assert np.allclose(pose[:3, 2], [0, 0, -1]) and np.allclose(-pose[:3, 1], [0, 1, 0], atol=1e-12)
    assert np.isclose(np.linalg.det(pose[:3, :3]), 1.0)
    nodding = downward_pose(0, 0, 3, 0.0, pitch=0.1)
    assert nodding[0, 2] < 0.0  # nose down: the camera looks back


@pytest.mark.parametrize(
    ("pose", "words"),
    [
        (downward_pose(8.0, 5.0, -5.0, 0.0), "has height -5.00 m, the seabed below it"),
        (downward_pose(8.0, 5.0, math.nan, 0.0), "finite"),
        (downward_pose(8.0, 5.0, 5.0, 0.0, pitch=1.4), "more than 60 degrees"),
    ],
)
def test_a_camera_where_it_cannot_be_is_refused(pose: np.ndarray, words: str) -> None:
    with pytest.raises(VisionError, match=words):
        render_pair(seabed(), CAMERA, pose, CLEAR, stream())


def test_rays_end_at_what_they_meet_first_where_slopes_hide_what_is_behind() -> None:
    steep = make_seabed(np.random.default_rng(4), relief=6.0, area=(0.0, 0.0, 12.0, 12.0), longest=12.0)
    pose = downward_pose(6.0, 6.0, steep.height(6.0, 6.0) + 1.2, heading=0.4)
    image, _ = render_pair(steep, CAMERA, pose, CLEAR, stream())
    assert image.std() > 5.0
    depths, first = np.arange(0.0, 20.0, 0.002), []
    for u, v in np.random.default_rng(5).uniform((0, 0), (600, 400), (60, 2)):
        ray = pose[:3, :3] @ ((u - CAMERA.center_x) / CAMERA.focal, (v - CAMERA.center_y) / CAMERA.focal, 1.0)
        below = [z <= steep.height(x, y) for x, y, z in pose[:3, 3] + depths[:, None] * ray]
        first.append((depths[int(np.argmax(below))], _first_hit(steep.grid, pose[:3, 3].copy(), *ray)))
    expected, found = np.array(first).T
    assert np.abs(found - expected).max() < 0.005
