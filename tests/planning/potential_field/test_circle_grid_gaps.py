"""The grid among circles cell by cell, and its paths against Dijkstra's on the same cells."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.potential_field.circle_grid import _SAFE, _frame, _gaps, grid_path
from lidarena.planning.potential_field.field_scene import FieldScene, make_scene
from tests.planning.grid.test_grid_search import slow_costs
from tests.planning.potential_field.circle_scenes import length, scattered

SEED = st.integers(0, 10**6)


def scene_of(seed: int, room: bool, robot: float = 1.0) -> FieldScene:
    circles, start, goal = scattered(np.random.default_rng(seed), 18)
    return make_scene(circles, start, goal, robot, (0, 0, 100, 100) if room else None)


def slow_gaps(scene: FieldScene, cell: float, reach: float) -> np.ndarray:
    frame, (rows, cols) = _frame(scene, cell)
    found = np.full((rows, cols), reach)
    for r in range(rows):
        for c in range(cols):
            x, y = frame[0] + (c + 0.5) * cell, frame[1] + (r + 0.5) * cell
            x0, y0, x1, y1 = scene.walls
            discs = np.hypot(scene.discs[:, 0] - x, scene.discs[:, 1] - y) - scene.discs[:, 2]
            found[r, c] = min(reach, x - x0, y - y0, x1 - x, y1 - y, *discs)
    return found


@settings(max_examples=12, deadline=None)
@given(SEED, st.booleans(), st.sampled_from([2.0, 3.7]), st.sampled_from([0.0, 2.5, 9.0]))
def test_a_cell_has_the_distance_to_the_nearest_surface(seed: int, room: bool, cell: float, reach: float) -> None:
    scene = scene_of(seed, room)
    frame, shape = _frame(scene, cell)
    gaps = np.empty(shape)
    _gaps(gaps, frame, scene.discs, scene.walls, reach)
    np.testing.assert_allclose(gaps, slow_gaps(scene, cell, reach), atol=1e-9)


@settings(max_examples=20, deadline=None)
@given(SEED, st.booleans())
def test_the_grid_holds_everything(seed: int, room: bool) -> None:
    scene = scene_of(seed, room)
    frame, (rows, cols) = _frame(scene, 1.5)
    high = frame[:2] + 1.5 * np.array([cols, rows])
    for point in (scene.start, scene.goal):
        assert (frame[:2] <= point).all() and (point <= high).all()
    if not room:
        for x, y, radius in scene.discs:
            assert (frame[:2] + radius <= (x, y)).all() and ((x, y) <= high - radius).all()


@settings(max_examples=12, deadline=None)
@given(SEED, st.sampled_from([(0.0, 0.0), (4.0, 3.0)]))
def test_between_its_end_cells_a_path_is_dijkstras(seed: int, options: tuple[float, float]) -> None:
    cell, (clearance, weight) = 2.5, options
    scene = scene_of(seed, True, 0.5)
    path = grid_path(scene, cell, clearance, weight)
    if not len(path):
        return
    frame, _ = _frame(scene, cell)
    cells = np.floor((path[1:-1] - frame[:2]) / cell)[:, ::-1].astype(int)
    gaps = slow_gaps(scene, cell, max(clearance, 2 * cell))
    lack = np.clip(1.0 - gaps / max(clearance, cell), 0.0, 1.0)
    cost = np.where(gaps > _SAFE * cell, 1.0 + weight * lack, np.inf)
    steps = np.hypot(*np.diff(cells, axis=0).T)
    spent = float((steps * cost[cells[1:, 0], cells[1:, 1]]).sum())
    expected = slow_costs(cost, tuple(cells[0].tolist()), True)[tuple(cells[-1])]
    assert spent == pytest.approx(expected)


def test_without_weight_the_path_is_the_shortest_on_its_grid() -> None:
    circles = [(50.0, 50.0, 12.0)]
    scene = make_scene(circles, (20.25, 50.25), (80.25, 50.25), 0.0, (0, 0, 100, 100))
    path = grid_path(scene, 0.5)
    direct = 2 * np.sqrt(30.0**2 - 12.0**2) + 12.0 * (np.pi - 2 * np.arccos(12.0 / 30.0))
    assert direct < length(path) < 1.09 * direct  # eight directions cost at most 8% more than all
