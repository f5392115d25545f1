"""Caves."""

import numpy as np
import pytest

from lidarena.world.random_plans import random_plan


@pytest.mark.parametrize("passage", [0.8, 1.4])
def test_passages_are_as_wide_as_asked_for(passage: float) -> None:
    """Wherever a robot can stand, one of nearly half the passage can stand close by."""
    plan = random_plan("cave", np.random.default_rng(3), area=120, passage=passage)
    raster = plan.raster(0.05)
    free = np.argwhere(~raster.solid & (raster.clearance >= 0.12))
    roomy = np.argwhere(~raster.solid & (raster.clearance >= 0.5 * passage - 0.15))
    for cell in free[::97]:
        assert np.hypot(*(roomy - cell).T).min() * 0.05 <= passage


def test_caves_have_slanted_outlines_and_no_circles() -> None:
    plan = random_plan("cave", np.random.default_rng(1), area=80)
    assert (plan.edges[:, :2] != plan.edges[:, 2:]).all(axis=1).sum() > 10
    assert len(plan.circles) == 0
