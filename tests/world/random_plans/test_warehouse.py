"""Warehouses."""

import numpy as np

from lidarena.world.random_plans.warehouse import random_warehouse


def test_posts_take_the_place_of_solid_racks() -> None:
    solid = random_warehouse(np.random.default_rng(4), {"area": 100.0, "posts": 0.0}, "x")
    posts = random_warehouse(np.random.default_rng(4), {"area": 100.0, "posts": 1.0}, "x")
    assert len(solid.circles) == 0 < len(solid.edges) - 16
    assert len(posts.circles) > 6 and (posts.circles[:, 2] <= 0.03).all()


def test_no_robot_fits_between_a_post_and_what_is_stored_beside_it() -> None:
    """It would be let into slits that it cannot turn in, behind posts."""
    for seed in range(10):
        plan = random_warehouse(np.random.default_rng(seed), {"area": 100.0, "posts": 1.0}, "x")
        boxes = plan.edges[16:].reshape(-1, 4, 4)
        gaps = [np.abs(np.unique(box[:, [0, 2]])[:, None] - plan.circles[:, 0]).min() for box in boxes]
        gaps += [np.abs(np.unique(box[:, [1, 3]])[:, None] - plan.circles[:, 1]).min() for box in boxes]
        assert len(boxes) > 1 and max(gaps) < 0.1


def test_aisles_of_narrow_halls_are_narrower() -> None:
    plan = random_warehouse(np.random.default_rng(0), {"width": 3.0, "height": 9.0}, "x")
    assert len(plan.edges) > 16 or len(plan.circles)


def test_aisles_are_as_wide_as_asked_for() -> None:
    plan = random_warehouse(np.random.default_rng(2), {"area": 150.0, "aisle": 2.0}, "x")
    raster = plan.raster(0.05)
    assert raster.clearance[~raster.solid].max() >= 0.95
