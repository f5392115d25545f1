import math

import numpy as np
import pytest

from lidarena.world.raster import CLEARANCE_CAP, rasterize

SQUARE = [(1.0, 1.0), (3.0, 1.0), (3.0, 2.0), (1.0, 2.0)]
"""Counter-clockwise: the solid part is to the left of every edge."""


def edges_of(ring: list[tuple[float, float]]) -> np.ndarray:
    return np.array([[*a, *b] for a, b in zip(ring, ring[1:] + ring[:1], strict=True)])


def distance_to(ring: list[tuple[float, float]], x: float, y: float) -> float:
    def to_segment(a: tuple[float, float], b: tuple[float, float]) -> float:
        ex, ey = b[0] - a[0], b[1] - a[1]
        t = min(max(((x - a[0]) * ex + (y - a[1]) * ey) / (ex * ex + ey * ey), 0.0), 1.0)
        return math.hypot(x - a[0] - t * ex, y - a[1] - t * ey)

    return min(to_segment(a, b) for a, b in zip(ring, ring[1:] + ring[:1], strict=True))


@pytest.mark.parametrize("resolution", [0.05, 0.13])
def test_cells_of_a_block_are_solid_and_know_how_far_its_surface_is(resolution: float) -> None:
    rows, columns = math.ceil(3.0 / resolution), math.ceil(4.0 / resolution)
    raster = rasterize(edges_of(SQUARE), np.empty((0, 3)), np.zeros(2), resolution, (rows, columns))
    for row, column in np.ndindex(rows, columns):
        x, y = (column + 0.5) * resolution, (row + 0.5) * resolution
        away = distance_to(SQUARE, x, y)
        if away > 1e-9:
            assert raster.solid[row, column] == (1.0 < x < 3.0 and 1.0 < y < 2.0)
        assert raster.clearance[row, column] == pytest.approx(min(away, CLEARANCE_CAP), abs=1e-6)


def test_pillars_are_solid_whatever_they_overlap() -> None:
    circles = np.array([[1.0, 1.0, 0.5], [3.0, 1.5, 0.4]])
    raster = rasterize(edges_of(SQUARE), circles, np.zeros(2), 0.1, (30, 40))
    x, y = np.meshgrid((np.arange(40) + 0.5) * 0.1, (np.arange(30) + 0.5) * 0.1)
    within = (np.hypot(x - 1.0, y - 1.0) < 0.5) | (np.hypot(x - 3.0, y - 1.5) < 0.4)
    assert raster.solid[within].all()
    assert not raster.solid[(x < 0.5) | (y > 2.3)].any()


def test_a_room_is_solid_outside() -> None:
    """A ring in the other direction encloses free space, of winding number -1 seen from outside."""
    raster = rasterize(edges_of(SQUARE[::-1]), np.empty((0, 3)), np.zeros(2), 0.1, (30, 40), winding_outside=-1)
    assert not raster.solid[12:18, 12:28].any() and raster.solid[:9].all() and raster.solid[:, :9].all()
