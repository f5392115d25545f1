"""Footprints: which are simple, how far they reach, what convex parts they have."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import ConfigError
from lidarena.world.outlines import checked_outline, convex_parts, edge_distances, extents

L_SHAPE = np.array([[0.4, 0.1], [0.1, 0.1], [0.1, 0.4], [-0.1, 0.4], [-0.1, -0.1], [0.4, -0.1]])


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.integers(4, 9))
def test_star_shapes_are_simple_and_reach_as_far_as_their_corners(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    angles = (np.arange(count) + rng.uniform(-0.3, 0.3, count)) * 2 * np.pi / count
    away = rng.uniform(0.2, 0.6, count)
    corners = checked_outline(np.stack([away * np.cos(angles), away * np.sin(angles)], axis=1))
    assert extents(corners, np.arctan2(corners[:, 1], corners[:, 0]) - 1e-9) == pytest.approx(
        np.hypot(*corners.T), abs=1e-6
    )
    far = extents(corners, np.linspace(-np.pi, np.pi, 5000))
    assert far.min() == pytest.approx(edge_distances(corners).min(), abs=1e-3)
    areas = [cv2.contourArea(np.array(part, np.float32)) for part in convex_parts(corners)]
    assert sum(areas) == pytest.approx(cv2.contourArea(corners.astype(np.float32)), rel=0.02)


def test_parts_of_a_bent_outline_are_convex_and_those_of_a_convex_one_itself() -> None:
    corners = checked_outline(L_SHAPE)
    parts = convex_parts(corners)
    assert len(parts) > 1 and all(cv2.isContourConvex(np.array(part, np.float32)) for part in parts)
    box = np.array([[0.2, -0.1], [0.2, 0.1], [-0.2, 0.1], [-0.2, -0.1]])
    assert convex_parts(box) == [[tuple(corner) for corner in box.tolist()]]


@pytest.mark.parametrize(
    "corners",
    [
        [[0.2, 0.2], [0.2, 0.2], [-0.2, 0.2], [-0.2, -0.2]],  # a corner twice
        [[0.2, 0.2], [-0.2, 0.2], [0.2, 0.2], [-0.2, -0.2]],  # there and back
        [[0.2, 0.2], [-0.2, 0.2], [-0.2, -0.2], [0.0, 0.2], [0.2, -0.2]],  # a corner on an edge
    ],
)
def test_what_touches_itself_is_refused(corners: list[list[float]]) -> None:
    with pytest.raises(ConfigError, match="simple polygon"):
        checked_outline(corners)
