"""Matches over four images show the same ground."""

import numpy as np
import pytest

from lidarena.vision.features import KINDS, FeatureOptions, detect
from lidarena.vision.matching import match_pairs
from lidarena.vision.rigid_motion import moved
from tests.vision.scenes import CAMERA, motion_between, pair_at, pose_at


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("guessed", [True, False])
def test_what_is_matched_is_the_same_ground(kind: str, guessed: bool) -> None:
    options = FeatureOptions(kind=kind, count=250)
    step = 0.5 if guessed else 0.2
    a, b = (detect(pair_at(x), CAMERA, options) for x in (8.0, 8.0 + step))
    motion = motion_between(pose_at(8.0), pose_at(8.0 + step))
    found = match_pairs(a, b, CAMERA, options, motion if guessed else None)
    expected = CAMERA.project(moved(motion, CAMERA.triangulate(found.pixels_a)))
    off = np.abs(expected - found.pixels_b).max(axis=1)
    assert len(off) > 40 and np.median(off) < 1.0 and (off < 3.0).mean() > 0.85
    assert np.array_equal(found.pixels_a, a.pixels[found.first])
    assert (found.second == -1).all() == (kind == "tracks")


def test_black_images_match_nothing() -> None:
    for kind in KINDS:
        options = FeatureOptions(kind=kind, count=100)
        black = detect((np.zeros((400, 600), np.uint8),) * 2, CAMERA, options)
        some = detect(pair_at(8.0), CAMERA, options)
        assert len(match_pairs(black, some, CAMERA, options, np.eye(4)).first) == 0
        assert len(match_pairs(some, black, CAMERA, options).first) == 0 or kind == "tracks"
