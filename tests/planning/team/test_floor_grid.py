import numpy as np
import pytest

from lidarena.base.errors import TeamError
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.world.floorplan import Floorplan

ROOM = Floorplan.from_shapes(
    "room",
    (0.0, 0.0, 4.0, 2.0),
    [(0.1, 0.1, 3.9, 0.1), (3.9, 0.1, 3.9, 1.9), (3.9, 1.9, 0.1, 1.9), (0.1, 1.9, 0.1, 0.1), (2.0, 0.1, 2.0, 1.1)],
    thickness=0.2,
)


def test_cells_are_blocked_where_the_walls_are():
    grid = FloorGrid.of(ROOM, 0.2)
    free = ~grid.blocked
    assert free.sum() == 18 * 8 - 2 * 5  # the inner wall lies across two columns, which are both too narrow beside it
    assert not grid.blocked[tuple(grid.cells([(0.3, 0.3)])[0])] and grid.blocked[tuple(grid.cells([(0.1, 0.3)])[0])]


def test_thin_walls_are_not_lost_on_coarse_cells():
    plan = Floorplan.from_shapes(
        "thin", (0, 0, 6, 6), [(0, 0, 6, 0), (6, 0, 6, 6), (6, 6, 0, 6), (0, 6, 0, 0), (3.0, 0, 3.0, 6)], thickness=0.1
    )
    for resolution in (0.2, 0.35, 0.6):
        grid = FloorGrid.of(plan, resolution)
        assert grid.blocked.all(axis=0)[1:-1].any(), resolution


def test_cells_and_points_are_each_others_inverse():
    grid = FloorGrid.of(ROOM, 0.25)
    cells = np.argwhere(~grid.blocked)
    assert np.array_equal(grid.cells(grid.points(cells)), cells)
    assert grid.in_cells(0.5) == 2.0


def test_bad_input_is_refused():
    with pytest.raises(TeamError, match=r"resolution of 0\.0 m"):
        FloorGrid.of(ROOM, 0.0)
    with pytest.raises(TeamError, match=r"point \(40, 1\)"):
        FloorGrid.of(ROOM).cells([(40.0, 1.0)])
