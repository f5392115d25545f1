import numpy as np
import pytest

from lidarena.world.canvas import BLUE, GREEN, RED, Canvas, draw_floorplan, write
from lidarena.world.drawings import env1

BOUNDS = (-1.0, 2.0, 3.0, 4.0)


def pixel(canvas: Canvas, x: float, y: float) -> tuple[int, ...]:
    row = canvas.image.shape[0] - 1 - int((y - canvas.bounds[1]) * canvas.scale)
    return tuple(canvas.image[row, int((x - canvas.bounds[0]) * canvas.scale)].tolist())


def test_a_canvas_is_white_and_as_large_as_its_piece_of_the_plane() -> None:
    canvas = Canvas(BOUNDS, 50.0)
    assert canvas.image.shape == (100, 200, 3) and (canvas.image == 255).all()


def test_what_is_drawn_stands_where_it_is_with_y_up() -> None:
    canvas = Canvas(BOUNDS, 50.0)
    canvas.dots(np.array([[0.0, 3.5]]), RED, 4.0)
    canvas.line(np.array([[1.0, 2.5], [2.0, 2.5]]), BLUE, 5)
    assert pixel(canvas, 0.0, 3.5) == RED and pixel(canvas, 1.5, 2.5) == BLUE
    assert pixel(canvas, 0.0, 2.5) == pixel(canvas, 1.5, 3.5) == (255, 255, 255)


def test_a_grid_covers_its_cells_and_nothing_else() -> None:
    canvas = Canvas(BOUNDS, 50.0)
    colours = np.array([[RED, BLUE], [GREEN, RED]], np.uint8)
    canvas.cells(colours, np.array([0.0, 2.5]), 0.5)
    assert [pixel(canvas, x, y) for x, y in ((0.2, 2.7), (0.7, 2.7), (0.2, 3.2), (0.7, 3.2))] == [RED, BLUE, GREEN, RED]
    assert (canvas.image != 255).any(axis=2).sum() == 50 * 50


@pytest.mark.parametrize("heading", [0.0, 0.5 * np.pi, np.pi])
def test_a_robot_points_where_it_heads(heading: float) -> None:
    canvas = Canvas(BOUNDS, 50.0)
    canvas.robot(np.array([1.0, 3.0, heading]), 0.2, GREEN)
    ahead = np.array([np.cos(heading), np.sin(heading)])
    assert pixel(canvas, *(np.array([1.0, 3.0]) + 0.33 * ahead)) == GREEN
    assert pixel(canvas, *(np.array([1.0, 3.0]) - 0.33 * ahead)) == (255, 255, 255)


def test_an_ellipse_is_two_standard_deviations_wide() -> None:
    canvas = Canvas(BOUNDS, 100.0)
    canvas.ellipse(np.array([1.0, 3.0]), np.diag([0.25, 0.01]), RED)
    rows, columns = np.nonzero((canvas.image == np.array(RED)).all(axis=2))
    assert np.ptp(columns) / 100.0 == pytest.approx(2.0, abs=0.05)
    assert np.ptp(rows) / 100.0 == pytest.approx(0.4, abs=0.05)


def test_a_floor_plan_is_dark_where_it_is_solid() -> None:
    plan = env1()
    canvas = Canvas(plan.bounds, 40.0)
    draw_floorplan(canvas, plan)
    raster = plan.raster(0.05)
    for row, column in np.argwhere(raster.clearance > 0.1)[::97]:
        x, y = raster.origin + (np.array([column, row]) + 0.5) * raster.resolution
        if plan.bounds[0] < x < plan.bounds[2] and plan.bounds[1] < y < plan.bounds[3]:
            assert (pixel(canvas, x, y) == (255, 255, 255)) != bool(raster.solid[row, column])


def test_text_ends_where_it_says() -> None:
    image = np.full((40, 200, 3), 255, np.uint8)
    end = write(image, "lidarena", 10, 25)
    columns = np.nonzero((image < 128).all(axis=2))[1]
    assert columns.min() >= 9 and end - 4 <= columns.max() <= end + 1
