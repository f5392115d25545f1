import numpy as np
import pytest
from gymnasium import Env
from matplotlib.figure import Figure

from lidarena.evaluation.trace import BelievedMap, TeamTrace, Walls, draw_end

SQUARE = Walls(np.array([[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 4.0, 3.0]]), np.array([[1.0, 1.0, 0.5]]))


def test_corners_enclose_walls_and_pillars() -> None:
    corners = Walls(circles=np.array([[5.0, -2.0, 1.0]])).corners()
    assert corners.min(axis=0).tolist() == [4.0, -3.0] and corners.max(axis=0).tolist() == [6.0, -1.0]
    assert SQUARE.corners().max(axis=0).tolist() == [4.0, 3.0]


def test_an_environment_without_a_floor_plan_has_no_walls() -> None:
    walls = Walls.of(Env())
    axes = Figure().add_subplot()
    walls.draw(axes)
    assert not len(walls.corners()) and not axes.get_legend_handles_labels()[1]


def test_what_is_drawn_is_explained_once() -> None:
    axes = Figure().add_subplot()
    SQUARE.draw(axes)
    assert axes.get_legend_handles_labels()[1] == ["true walls"]
    assert len(axes.patches) == 1 and len(axes.collections[0].get_segments()) == 2


def test_a_believed_map_is_drawn_where_it_lies() -> None:
    cells = np.full((4, 6), -1, np.int8)
    cells[1, 2], cells[2, 3] = 0, 100
    grid = BelievedMap(cells, 0.5, np.array([1.0, 2.0]))
    corners = grid.corners()
    assert (corners >= (1.0, 2.0)).all() and (corners <= (4.0, 4.0)).all()
    axes = Figure().add_subplot()
    grid.draw(axes)
    (image,) = axes.images
    assert image.get_extent() == pytest.approx([1.0, 4.0, 2.0, 4.0])


def test_a_team_is_drawn_robot_by_robot() -> None:
    paths = np.cumsum(np.full((5, 3, 2), 0.1), axis=0)
    trace = TeamTrace(paths, np.ones((3, 2)), np.array([False, True, False]), SQUARE)
    axes = Figure().add_subplot()
    trace.draw(axes)
    x_min, x_max, y_min, y_max = trace.bounds()
    assert x_min <= 0.0 and x_max >= 4.0 and y_min <= 0.0 and y_max >= 3.0
    drawn = [line for line in axes.lines if len(line.get_xydata()) == 5]
    assert len(drawn) == 3


def test_a_crash_does_not_look_like_an_arrival() -> None:
    marks = []
    for crash in (False, True):
        axes = Figure().add_subplot()
        draw_end(axes, np.array([1.0, 2.0]), crash)
        marks.append([(line.get_marker(), line.get_color()) for line in axes.lines])
    assert marks[0] != marks[1]
