"""Transforms between a robot's frames: fixed ones chained, the moving one found."""

import math

import numpy as np

from lidarena.slam.logs.tf_tree import TransformTree


def tree() -> TransformTree:
    found = TransformTree()
    for k in range(5):
        found.add("/map", "odom", float(k), (0.1 * k, 0.0, 0.0))
        found.add("odom", "/base_link", float(k), (float(k), 0.0, 0.1 * k))
    found.add("base_link", "tower", 0.0, (0.2, 0.0, math.pi / 2))
    found.add("tower", "laser", 0.0, (0.1, 0.0, 0.0))
    return found


def test_fixed_transforms_are_chained_and_moving_ones_are_not() -> None:
    np.testing.assert_allclose(tree().fixed("base_link", "laser"), (0.2, 0.1, math.pi / 2), atol=1e-12)
    assert tree().fixed("odom", "laser") is None and tree().fixed("base_link", "camera") is None


def test_the_robots_way_is_the_transform_out_of_the_odometry_frame() -> None:
    moving = tree().moving("laser")
    assert moving is not None and moving[2] == "base_link"
    np.testing.assert_allclose(moving[1][:, 0], np.arange(5.0))
    assert TransformTree().moving("laser") is None
