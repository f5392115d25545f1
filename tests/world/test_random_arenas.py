import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import MapError
from lidarena.world.random_arenas import DENSITIES, random_arena_shapes, u_trap_shapes


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(DENSITIES))
def test_a_random_arena_is_as_dense_as_asked_and_leaves_room_for_both_ends(seed: int, density: float) -> None:
    circles, start, goal, (low_x, low_y, high_x, high_y), radius = random_arena_shapes(seed, density)
    share = math.pi * (circles[:, 2] ** 2).sum() / ((high_x - low_x) * (high_y - low_y))
    assert density <= share < density + math.pi * 25.0 / 1e4
    assert math.dist(start, goal) >= 60.0
    for x, y in (start, goal):
        assert (np.hypot(circles[:, 0] - x, circles[:, 1] - y) - circles[:, 2] > radius + 1.0).all()


def test_the_same_seed_draws_the_same_arena_and_another_another() -> None:
    one, same, other = (random_arena_shapes(seed, 0.15)[0] for seed in (3, 3, 4))
    assert np.array_equal(one, same) and not np.array_equal(one, other)


@pytest.mark.parametrize("density", [-0.01, 0.31, math.nan])
def test_a_density_out_of_range_is_refused(density: float) -> None:
    with pytest.raises(MapError, match=r"0 to 0\.3 are allowed"):
        random_arena_shapes(0, density)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
def test_a_u_trap_lies_across_the_straight_way_and_is_closed_for_the_robot(seed: int) -> None:
    circles, start, goal, _, radius = u_trap_shapes(seed)
    trap = circles[circles[:, 2] == 0.8]
    gaps = np.hypot(*np.diff(trap[:, :2], axis=0).T) - 1.6
    assert gaps.max() < 2.0 * radius
    way = np.linspace(start, goal, 2000)
    away = np.hypot(way[:, None, 0] - circles[:, 0], way[:, None, 1] - circles[:, 1]) - circles[:, 2]
    assert away.min() < radius  # the straight way touches something
    assert min(away[0].min(), away[-1].min()) > radius
