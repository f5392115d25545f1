"""Correlative matching finds a pose however wrong the guess."""

import numpy as np
import pytest

from lidarena.slam.graph.correlation import CELL, CELLS, best_in_window, draw_scan, empty_grid
from tests.slam.graph.test_point_to_line import scans


@pytest.mark.parametrize("wrong", [(0.0, 0.0, 0.7), (0.3, -0.3, -0.7), (-0.4, 0.2, 0.0)])
def test_a_guess_wrong_by_tens_of_degrees_is_mended(wrong: tuple[float, float, float]) -> None:
    true = np.array([0.5, 0.3, 0.2])
    store = scans((0, 0, 0), tuple(true))
    grid = empty_grid()
    draw_scan(grid, store, 0, np.zeros(3), 1)
    loose = np.array([10.0, 10.0])
    found = best_in_window(grid, store, 1, true + wrong, np.array([0.5, 0.8]), np.array([0.1, 0.035]), loose, 90)
    assert np.abs(found[:2] - true[:2]).max() <= 0.11 and abs(found[2] - true[2]) < 0.06
    assert 0.3 < found[3] <= 1.0


def test_where_everything_fits_the_guess_is_kept() -> None:
    store, grid = scans((0, 0, 0)), empty_grid()
    grid.likelihood[:] = 200
    window, steps, spread = np.array([0.3, 0.3]), np.array([0.1, 0.1]), np.array([0.1, 0.1])
    found = best_in_window(grid, store, 0, np.array([0.1, 0.2, 0.3]), window, steps, spread, 60)
    np.testing.assert_allclose(found, [0.1, 0.2, 0.3, 200 / 255])


def test_the_grid_repeats_itself_and_is_wiped_clean() -> None:
    store, near, far = scans((0, 0, 0)), empty_grid(), empty_grid()
    draw_scan(near, store, 0, np.array([1.0, 1.0, 0.0]), 1)
    draw_scan(far, store, 0, np.array([1.0 + CELL * CELLS, 1.0, 0.0]), 1)
    assert (near.likelihood != far.likelihood).mean() < 1e-3 and near.likelihood.any()
    draw_scan(near, store, 0, np.array([1.0, 1.0, 0.0]), -1)
    assert not near.likelihood.any()
