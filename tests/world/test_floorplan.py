import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan
from lidarena.world.raster import CLEARANCE_CAP

BOX = [(0, 0, 4, 0), (4, 0, 4, 3), (4, 3, 0, 3), (0, 3, 0, 0)]


def box(**keywords: object) -> Floorplan:
    return Floorplan.from_shapes("box", (0, 0, 4, 3), walls=BOX, **keywords)  # type: ignore[arg-type]


def test_walls_polygons_and_circles_are_solid_inside() -> None:
    plan = box(polygons=[[(1, 1), (1, 2), (2, 2), (2, 1)]], circles=[(3, 1.5, 0.3)], start=(0.5, 0.5, 0))
    clearance = plan.clearance(np.array([[1.5, 1.5], [3, 1.5], [0.5, 0.5], [0.0, 1.0], [3.0, 2.0]]))
    assert clearance == pytest.approx([-0.5, -0.3, 0.45, -0.05, 0.2])


def test_default_start_is_the_roomiest_place() -> None:
    plan = box(start=None)
    assert plan.clearance(np.array([plan.start[:2]]))[0] >= CLEARANCE_CAP - 0.01


@pytest.mark.parametrize("start", [(0.0, 1.0, 0.0), (0.1, 1.0, 0.0), (9.0, 1.0, 0.0)])
def test_start_in_a_wall_or_outside_is_refused(start: tuple[float, float, float]) -> None:
    with pytest.raises(MapError, match="stands in a wall"):
        box(start=start)


def test_start_that_is_not_finite_is_refused() -> None:
    with pytest.raises(MapError, match="not finite"):
        box(start=(float("nan"), 1.0, 0.0))


def test_start_heading_is_wrapped() -> None:
    assert box(start=(2, 1.5, 7.0)).start[2] == pytest.approx(7.0 - 2 * np.pi)


def test_a_grid_without_free_cells_is_refused() -> None:
    with pytest.raises(MapError, match="no free space"):
        Floorplan.from_grid("full", np.ones((4, 5), np.bool_), 0.1)


def test_a_grid_with_room_for_no_robot_is_refused() -> None:
    occupied = np.ones((5, 5), np.bool_)
    occupied[2, 2] = False
    with pytest.raises(MapError, match="clearance"):
        Floorplan.from_grid("slit", occupied, 0.1)


def test_empty_bounds_and_infinite_coordinates_are_refused() -> None:
    with pytest.raises(MapError, match="empty bounds"):
        Floorplan.from_shapes("none", (1, 0, 1, 3))
    with pytest.raises(MapError, match="not finite"):
        Floorplan.from_shapes("far", (0, 0, 4, 3), walls=[(0, 0, np.inf, 0)])


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.floats(-3.0, 3.0), st.integers(4, 12), st.integers(4, 12))
def test_grid_cells_are_solid_exactly_where_occupied(seed: int, yaw: float, rows: int, columns: int) -> None:
    occupied = np.random.default_rng(seed).random((rows, columns)) < 0.4
    occupied[:2, :2] = False
    plan = Floorplan.from_grid("grid", occupied, 0.5, (1.0, -2.0, yaw))
    row, column = np.indices(occupied.shape).reshape(2, -1)
    local = (np.stack([column, row], axis=1) + 0.5) * 0.5
    turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    clearance = plan.clearance(local @ turn + (1.0, -2.0))
    assert np.array_equal(clearance < 0, occupied.ravel())
    assert (np.abs(clearance) >= 0.25 - 1e-9).all()


def test_runs_of_cell_sides_become_single_edges() -> None:
    occupied = np.zeros((40, 60), np.bool_)
    occupied[10:20, 5:50] = True
    assert len(Floorplan.from_grid("block", occupied, 0.1).edges) == 8


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(*[st.floats(0.0, 4.0)] * 4), max_size=8), st.floats(0.02, 0.3))
def test_raster_agrees_with_the_exact_clearance(walls: list[tuple[float, ...]], thickness: float) -> None:
    plan = Floorplan.from_shapes(
        "drawn", (0, 0, 6, 4), walls=[*walls, (5.5, 0, 5.5, 4)], circles=[(5, 3, 0.3)], thickness=thickness
    )
    raster = plan.raster(0.1)
    rows, columns = raster.solid.shape
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    centres = raster.origin + (np.stack([x.ravel(), y.ravel()], axis=1) + 0.5) * 0.1
    exact = plan.clearance(centres)
    sure = np.abs(exact) > 1e-6
    assert np.array_equal(raster.solid.ravel()[sure], (exact < 0)[sure])
    assert np.allclose(raster.clearance.ravel(), np.minimum(np.abs(exact), CLEARANCE_CAP), atol=1e-5)
