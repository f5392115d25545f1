"""The outline of what a scan saw free."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.path import Path

from lidarena.slam.scan_outline import empty_outlines, outline_scan

BEAMS, ROWS, COLUMNS, REACH = 360, 90, 100, 3.5
ANGLES = np.arange(BEAMS) * (2 * math.pi / BEAMS)
DIRECTIONS = np.stack([np.cos(ANGLES), np.sin(ANGLES)])


def surfaces(seed: int) -> np.ndarray:
    """A scan of several surfaces with jumps between them, some beams without return, some blind."""
    rng = np.random.default_rng(seed)
    scan = np.repeat(rng.uniform(0.3, 3.4, 12), 30) * (1 + 0.05 * np.sin(7 * ANGLES))
    scan[rng.integers(0, 330) :][:25] = REACH
    scan[rng.integers(0, 350) :][:5] = 0.0
    return scan.astype(np.float32)


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.5, 4.5), st.floats(0.5, 4.0), st.floats(-3.1, 3.1))
def test_runs_of_cells_are_the_inside_of_the_outline(seed: int, x: float, y: float, theta: float) -> None:
    outlines, scan = empty_outlines(1, ROWS, BEAMS, REACH, 0.05), surfaces(seed)
    u, v = x / 0.05, y / 0.05
    pose = (u, v, math.cos(theta), math.sin(theta))
    outline_scan(outlines, 0, COLUMNS, *pose, 0.05, scan, DIRECTIONS, REACH)
    inside = np.zeros((ROWS, COLUMNS), bool)
    for row in range(ROWS):
        columns, k = [], outlines.heads[0, row]
        while k >= 0:
            columns.append(int(outlines.crossings[0, k, 0]))
            k = outlines.crossings[0, k, 1]
        assert len(columns) % 2 == 0 and columns == sorted(columns)
        assert all(0 <= column <= COLUMNS for column in columns)
        for first, last in zip(columns[::2], columns[1::2], strict=True):
            inside[row, first:last] = True
    reaches = outlines.reaches[0]
    turned = ANGLES + theta
    corners = reaches[:, :, None] * np.stack([np.cos(turned), np.sin(turned)], axis=1)[:, None]
    outline = Path(np.array([u, v]) + corners.reshape(-1, 2), closed=False)
    column, row = np.meshgrid(np.arange(COLUMNS) + 0.5, np.arange(ROWS) + 0.5)
    centres = np.column_stack([column.ravel(), row.ravel()])
    expected = outline.contains_points(centres).reshape(ROWS, COLUMNS)
    assert (inside != expected).sum() <= 3  # centres on an edge to the last bit
    assert (reaches * 0.05 <= np.minimum(scan, REACH)[:, None] + 1e-6).all()
