import numpy as np
import pytest

from lidarena.base.errors import MapError, TeamError
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
    hall = Floorplan.from_shapes("hall", (0.0, 0.0, 300.0, 300.0), [(0.0, 0.0, 300.0, 0.0)], thickness=0.2)
    with pytest.raises(MapError, match=r"'hall' has 15000 x 15000 cells.* so they must be larger ones"):
        FloorGrid.of(hall, 0.02)


def test_by_clearance_robots_stand_wherever_they_fit():
    grid = FloorGrid.of(ROOM, 0.1, exact=True)
    for radius in (0.05, 0.2, 0.33):
        graph = grid.graph(radius)
        points = grid.points(np.argwhere(graph.index >= 0))
        assert ROOM.clearance(points).min() >= radius - 1e-3
        inside = grid.points(np.argwhere(np.ones(grid.blocked.shape, bool)))
        low, high = np.array(ROOM.bounds[:2]), np.array(ROOM.bounds[2:])
        inside = inside[((inside > low) & (inside < high)).all(axis=1)]
        fitting = ROOM.clearance(inside) >= radius + 1e-3
        assert fitting.sum() <= len(points)
        assert graph.index[tuple(grid.cells(inside[fitting]).T)].min() >= 0


def test_taken_cells_are_kept_clear_of_and_points_beside_walls_get_the_nearest_cell():
    grid = FloorGrid.of(ROOM, 0.1, exact=True)
    taken = np.zeros(grid.blocked.shape, bool)
    taken[tuple(grid.cells([(1.05, 1.05)])[0])] = True
    graph = grid.graph(0.2, taken)
    away = np.hypot(*(grid.points(graph.cells) - (1.05, 1.05)).T)
    assert away.min() >= 0.2 and len(graph) < len(grid.graph(0.2))
    beside = np.array([(0.36, 0.75)])  # 0.16 m from the wall
    cell = grid.standing(beside, graph)
    assert graph.place(cell[0]) >= 0 and np.hypot(*(grid.points(cell) - beside).T) < 0.15
    assert np.array_equal(FloorGrid.of(ROOM, 0.1).standing(beside, graph), grid.cells(beside))


def test_closed_cells_are_left_out_as_they_are():
    """Discs keep away from blocked cells by their radius, and from closed ones not at all."""
    blocked = np.zeros((9, 9), bool)
    blocked[4, 4] = True
    grid = FloorGrid(blocked, (0.0, 0.0), 0.2)
    closed = np.zeros_like(blocked)
    closed[4, 7] = True
    with_it, without = grid.graph(0.2, closed=closed), grid.graph(0.2)
    assert np.argwhere((without.index >= 0) != (with_it.index >= 0)).tolist() == [[4, 7]]
    assert with_it.apart == without.apart
