"""RANSAC finds the motion on which most matches agree."""

import numpy as np
import pytest

from lidarena.vision.consensus import find_motion
from lidarena.vision.rigid_motion import inverse, vector_of
from tests.vision.scenes import CAMERA, matches_of, some_motion, stream


@pytest.mark.parametrize("wrong", [0.0, 0.3, 0.5])
def test_wrong_matches_are_found_out(wrong: float) -> None:
    matches, right = matches_of(some_motion(), 150, 0.2, wrong)
    clouds = CAMERA.triangulate(matches.pixels_a), CAMERA.triangulate(matches.pixels_b)
    motion, agree = find_motion(CAMERA, *clouds, matches.pixels_b, 3.0, stream())
    off = inverse(motion) @ some_motion()
    assert np.linalg.norm(vector_of(off[:3, :3])) < 0.03 and np.linalg.norm(off[:3, 3]) < 0.15
    assert not (agree & ~right).any() and (agree & right).sum() > 0.6 * right.sum()


def test_the_same_stream_draws_the_same_samples() -> None:
    matches, _ = matches_of(some_motion(), 60, 0.5, 0.4)
    clouds = CAMERA.triangulate(matches.pixels_a), CAMERA.triangulate(matches.pixels_b)
    found = [find_motion(CAMERA, *clouds, matches.pixels_b, 3.0, stream(seed))[0] for seed in (4, 4, 5)]
    assert np.array_equal(found[0], found[1]) and not np.array_equal(found[0], found[2])


def test_points_on_a_line_determine_nothing() -> None:
    points = np.linspace([0.0, 0.0, 5.0], [1.0, 0.0, 5.0], 10)
    motion, agree = find_motion(CAMERA, points, points, CAMERA.project(points), 2.0, stream())
    assert np.array_equal(motion, np.eye(4)) and not agree.any()
