"""Rooms and doors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.world.random_plans.rooms import draw_rooms


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([25.0, 60.0, 200.0]))
def test_rooms_tile_the_plan_and_doors_lie_in_inner_walls(seed: int, area: float) -> None:
    plan = draw_rooms(np.random.default_rng(seed), {"area": area})
    inner = (plan.size[0] - plan.thickness) * (plan.size[1] - plan.thickness)
    assert sum(width * height for width, height in (room.sides for room in plan.rooms)) == pytest.approx(inner)
    assert len(plan.doors) >= len(plan.rooms) - 1  # a spanning tree at least
    assert (plan.doors[:, 2] >= 0.8 - 1e-9).all()
    assert (plan.doors[:, 0] > 0.3).all() and (plan.doors[:, 0] < plan.size[0] - 0.3).all()


def test_more_loops_are_more_doors() -> None:
    few, many = (draw_rooms(np.random.default_rng(8), {"area": 200.0, "loops": loops}).doors for loops in (0.0, 1.0))
    assert len(few) < len(many)
