"""Connected cells and extents are those that OpenCV and NumPy find."""

import cv2
import numpy as np
import pytest

from lidarena.planning.grid.connected import connected_cells, known_extent


@pytest.mark.parametrize("share", [0.3, 0.55, 0.65, 0.9, 1.0])
@pytest.mark.parametrize("shape", [(1, 40), (40, 1), (37, 53)])
def test_it_is_the_part_that_labelling_finds(share: float, shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(int(100 * share) + shape[0])
    for _ in range(20):
        passable = rng.random(shape) < share
        row, col = (int(k) for k in rng.choice(np.argwhere(passable))) if passable.any() else (0, 0)
        passable[row, col] = True
        _, labels = cv2.connectedComponents(passable.astype(np.uint8), connectivity=4)
        np.testing.assert_array_equal(connected_cells(passable, row, col), labels == labels[row, col])


def test_a_spiral_and_a_comb_are_one_part() -> None:
    comb = np.zeros((60, 61), bool)
    comb[0], comb[:, ::2] = True, True
    assert (connected_cells(comb, 59, 60) == comb).all()
    stairs = np.add.outer(np.arange(30), np.arange(30)) % 2 == 0
    assert connected_cells(stairs, 0, 0).sum() == 1, "cells that touch by a corner are not connected"


@pytest.mark.parametrize("known", [0, 1, 5, 400])
def test_the_extent_is_that_of_all_known_cells(known: int) -> None:
    rng = np.random.default_rng(known)
    grid = np.full((23, 31), -1, np.int8)
    grid.reshape(-1)[rng.choice(grid.size, known, replace=False)] = rng.choice([0, 100], known)
    rows, cols = np.flatnonzero((grid >= 0).any(axis=1)), np.flatnonzero((grid >= 0).any(axis=0))
    expected = (rows[0], rows[-1] + 1, cols[0], cols[-1] + 1) if known else (0, 0, 0, 0)
    assert known_extent(grid) == expected
