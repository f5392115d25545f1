"""Caves."""

import numpy as np
import pytest

from lidarena.world.random_plans import random_plan


@pytest.mark.parametrize("passage", [0.8, 1.4])
def test_passages_are_as_wide_as_asked_for(passage: float) -> None:
    """Every free place lies in a disc of nearly the passage's width that is free: what is narrower has been filled."""
    for seed in range(4):
        raster = random_plan("cave", np.random.default_rng(seed), area=100, passage=passage).raster(0.05)
        free = np.argwhere(~raster.solid)
        roomy = np.argwhere(~raster.solid & (raster.clearance >= 0.5 * passage - 0.06))
        for cell in free[::97]:
            assert np.hypot(*(roomy - cell).T).min() * 0.05 <= 0.5 * passage + 0.12


def test_caves_have_slanted_outlines_and_no_circles() -> None:
    plan = random_plan("cave", np.random.default_rng(1), area=80)
    assert (plan.edges[:, :2] != plan.edges[:, 2:]).all(axis=1).sum() > 30
    assert len(plan.circles) == 0


def test_caves_fill_a_good_part_of_their_size_and_stay_inside() -> None:
    for seed in range(12):
        plan = random_plan("cave", np.random.default_rng(seed), width=10, height=8)
        points = plan.edges.reshape(-1, 2)
        assert (points > 0.0).all() and (points < (10.0, 8.0)).all()
        assert (np.ptp(points, axis=0) > (6.8, 5.4)).all()
        assert (~plan.raster(0.05).solid).sum() * 0.05**2 >= 0.3 * 80


def test_wide_passages_come_out_where_rock_is_not_given() -> None:
    for seed in range(8):
        random_plan("cave", np.random.default_rng(seed), area=30, passage=2.0)
