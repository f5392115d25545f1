"""Mazes on a grid: one way between any two places, corridors as wide as asked for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import binary_opening, label

from lidarena.base.errors import MapError
from lidarena.world.grid_mazes import draw_grid_maze


@given(st.integers(0, 10_000), st.integers(1, 4), st.integers(4, 40))
def test_connected_without_loops_and_nowhere_narrower(seed: int, corridor: int, side: int) -> None:
    blocked = draw_grid_maze(np.random.default_rng(seed), side, corridor)
    assert blocked.shape == (side, side)
    assert label(~blocked)[1] == 1
    around = np.pad(blocked, 1, constant_values=True)
    assert label(around, np.ones((3, 3)))[1] == 1  # a loop would cut a wall off from the rim
    assert np.array_equal(binary_opening(~around, np.ones((corridor, corridor))), ~around)
    places = (side + 1) // (corridor + 1)
    assert (~blocked).sum() == places**2 * corridor**2 + (places**2 - 1) * corridor  # a tree of places


def test_a_seed_is_a_maze() -> None:
    first, second = (draw_grid_maze(np.random.default_rng(5)) for _ in range(2))
    assert np.array_equal(first, second)
    assert not np.array_equal(first, draw_grid_maze(np.random.default_rng(6)))


@pytest.mark.parametrize(("side", "corridor"), [(2, 3), (8, 0)])
def test_no_room(side: int, corridor: int) -> None:
    with pytest.raises(MapError, match=f"a corridor of {corridor} cells does not fit into a maze of {side} x {side}"):
        draw_grid_maze(np.random.default_rng(0), side, corridor)
