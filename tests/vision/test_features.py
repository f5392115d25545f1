"""Features of a pair keep to the epipolar constraint, and lie where they are."""

import numpy as np
import pytest

from lidarena.base.errors import ConfigError, VisionError
from lidarena.vision.features import KINDS, FeatureOptions, detect, even, match_descriptors, track
from lidarena.vision.seabed_renderer import downward_pose, render_pair
from lidarena.vision.water import Water
from tests.vision.scenes import CAMERA, pair_at, seabed, stream

FEW = {kind: FeatureOptions(kind=kind, count=150) for kind in KINDS}
every_kind = pytest.mark.parametrize("kind", KINDS)


@every_kind
def test_they_are_on_one_row_and_at_the_depth_of_the_seabed(kind: str) -> None:
    found = detect(pair_at(8.0), CAMERA, FEW[kind])
    assert len(found.pixels) > 50 and len(found.pixels) == len(found.sigma) == len(found.descriptors)
    assert CAMERA.epipolar_errors(found.pixels).max() <= 1.5
    depths = CAMERA.triangulate(found.pixels)[:, 2]
    right = (depths > 4.5) & (depths < 9.0)
    assert right.mean() > 0.93 and seabed().height(8.0, 5.4) == pytest.approx(5.0 - np.median(depths[right]), abs=0.6)


@every_kind
def test_only_a_region_is_looked_at(kind: str) -> None:
    found = detect(pair_at(8.0), CAMERA, FEW[kind], (200, 100, 500, 300)).pixels
    assert len(found) > 20 and found[:, 0].min() >= 199 and found[:, 0].max() <= 501
    assert found[:, 1].min() >= 99 and found[:, 1].max() <= 301


@every_kind
def test_black_and_featureless_images_have_none(kind: str) -> None:
    for grey in (0, 130):
        flat = np.full((400, 600), grey, np.uint8)
        assert len(detect((flat, flat), CAMERA, FEW[kind]).pixels) == 0


@every_kind
def test_with_left_and_right_swapped_nearly_nothing_fits(kind: str) -> None:
    left, right = pair_at(8.0)
    swapped, right_way = (len(detect(pair, CAMERA, FEW[kind]).pixels) for pair in ((right, left), (left, right)))
    assert swapped < 0.3 * right_way


def test_images_of_another_camera_are_refused() -> None:
    with pytest.raises(VisionError, match="the calibration is for 600 x 400"):
        detect((np.zeros((300, 600), np.uint8),) * 2, CAMERA, FEW["sift"])


def test_evening_out_takes_vignetting_away() -> None:
    rng = np.random.default_rng(0)
    texture = rng.normal(0, 10, (200, 600))
    shade = np.linspace(0.6, 1.0, 600)
    plain, dark = (even(np.clip((120 + texture) * share, 0, 255).astype(np.uint8)) for share in (1.0, shade))
    assert np.abs(plain.astype(int) - dark.astype(int))[60:140, 60:540].mean() < 4.0 < 0.2 * plain.std()


def test_descriptors_are_matched_mutually_and_clearly() -> None:
    rng = np.random.default_rng(0)
    one = rng.normal(size=(20, 32)).astype(np.float32)
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    order = rng.permutation(20)
    first, second = match_descriptors(one, one[order], 0.8)
    assert len(first) == 20 and np.array_equal(order[second], first)
    assert len(match_descriptors(one, np.vstack([one, one]), 0.8)[0]) == 0  # none is clearly the nearest
    likely = np.zeros((20, 20), np.bool_)
    likely[3, 3] = True
    assert [part.tolist() for part in match_descriptors(one, one, 0.8, likely)] == [[3], [3]]
    assert len(match_descriptors(one[:0], one, 0.8)[0]) == 0


def test_bits_are_matched_by_how_many_differ() -> None:
    one = np.random.default_rng(1).integers(0, 256, (9, 32), dtype=np.uint8)
    two = one.copy()
    two[:, 0] ^= 3
    assert np.array_equal(match_descriptors(one, two, 0.8)[1], np.arange(9))


def test_corners_are_found_in_both_images_on_near_ground_too() -> None:
    """1.5 m above the ground the images are apart by a quarter of their width."""
    low = downward_pose(8.0, 5.4, seabed().height(8.0, 5.4) + 1.5, 0.1)
    pair = render_pair(seabed(), CAMERA, low, Water(), stream(3))
    found = detect(pair, CAMERA, FeatureOptions(kind="tracks", count=150))
    disparity = found.pixels[:, 0] - found.pixels[:, 2]
    assert len(disparity) > 60 and 90.0 < np.median(disparity) < 190.0


def test_tracking_follows_a_shift_of_less_than_a_pixel() -> None:
    left, _ = pair_at(8.0)
    places = np.array([[100.0, 100.0], [300.0, 200.0]], np.float32)
    found, fits = track(left, np.roll(left, (2, 3), (0, 1)), places, places)
    assert fits.all() and np.allclose(found - places, [3.0, 2.0], atol=0.05)
    assert track(left, left, places[:0], places[:0])[0].shape == (0, 2)


@pytest.mark.parametrize("change", [{"kind": "surf"}, {"count": 2}, {"ratio": 0.0}, {"farthest": 0.1}])
def test_options_that_cannot_be_are_refused(change: dict[str, float]) -> None:
    with pytest.raises(ConfigError, match=next(iter(change))):
        FeatureOptions(**change)  # type: ignore[arg-type]
