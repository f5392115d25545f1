"""Warehouses."""

import numpy as np

from lidarena.world.random_plans.warehouse import random_warehouse


def test_posts_take_the_place_of_solid_racks() -> None:
    solid = random_warehouse(np.random.default_rng(4), {"area": 100.0, "posts": 0.0}, "x")
    posts = random_warehouse(np.random.default_rng(4), {"area": 100.0, "posts": 1.0}, "x")
    assert len(solid.circles) == 0 < len(solid.edges) - 16
    assert len(posts.edges) == 16 and len(posts.circles) > 6
    assert (posts.circles[:, 2] <= 0.03).all()


def test_aisles_are_as_wide_as_asked_for() -> None:
    plan = random_warehouse(np.random.default_rng(2), {"area": 150.0, "aisle": 2.0}, "x")
    raster = plan.raster(0.05)
    assert raster.clearance[~raster.solid].max() >= 0.95
