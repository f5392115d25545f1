"""The clearance between cells, lines of sight and arcs, against scipy and dense samples."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from lidarena.planning.grid.path_following import blocked_ahead, lookahead_point, predict
from lidarena.planning.grid.steering import Commands, loiter_gap, steer, tightest
from lidarena.planning.grid.surroundings import Surroundings, gap_at, in_sight
from tests.planning.grid.test_surroundings import RES, room

DISCRETE = Commands.of([(0.5, 0.0), (0.05, 0.3), (0.05, -0.3)], 0.2)
CONTINUOUS = Commands.of([(0.5, 0.0), (0.0, 1.0), (0.0, -1.0), (0.5, 0.5), (0.5, -0.5)], 0.2)
HALL = room(3.0, 2.0, [(1.4, 0.0, 1.6, 0.9), (0.5, 1.4, 0.8, 1.6)])
X, Y, TURN = st.floats(-0.3, 3.3), st.floats(-0.3, 2.3), st.floats(-math.pi, math.pi)
Point = tuple[float, float]
POINT = st.tuples(X, Y)


def gap_of(point: Point | np.ndarray, around: Surroundings = HALL) -> float:
    return gap_at(around.gap, around.closed, around.frame, float(point[0]), float(point[1]))


def slow_gap(x: float, y: float) -> float:
    """scipy's linear interpolation, the outermost cells carried on."""
    u, v = (x + RES) / RES, (y + RES) / RES
    rows, cols = HALL.gap.shape
    if not (0 <= u < cols and 0 <= v < rows) or HALL.closed[math.floor(v), math.floor(u)]:
        return -1.0
    where = [[v - 0.5], [u - 0.5]]
    return float(ndimage.map_coordinates(HALL.gap.astype(float), where, order=1, mode="nearest")[0])


@settings(max_examples=100, deadline=None)
@given(POINT)
def test_between_cells_the_clearance_is_interpolated(point: Point) -> None:
    assert gap_of(point) == pytest.approx(slow_gap(*point), abs=1e-6)


@settings(max_examples=80, deadline=None)
@given(POINT, POINT, st.sampled_from([0.0, 0.1, 0.25]))
def test_a_line_of_sight_keeps_its_clearance_at_every_sample(a: Point, b: Point, margin: float) -> None:
    shares = np.linspace(0.0, 1.0, 16 * max(1, math.ceil(math.dist(a, b) / (0.5 * RES))) + 1)[1:]
    samples = np.array(a) + shares[:, None] * np.subtract(b, a)
    slack = 1e-9 * np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)])  # the border of a closed cell is nobody's
    least = min(gap_of(sample) for sample in (samples[:, None] + slack).reshape(-1, 2))
    seen = in_sight(HALL, np.array(a), np.array(b), margin)
    if least >= margin + 1e-9:
        assert seen
    elif least < margin - 0.75 * RES and least >= 0:  # no sample may be missed by more than half its spacing
        assert not seen


@settings(max_examples=60, deadline=None)
@given(st.tuples(X, Y, TURN), st.lists(st.integers(0, 4), max_size=12))
def test_commands_are_driven_as_arcs(pose: tuple[float, float, float], sequence: list[int]) -> None:
    x, y, theta = pose
    expected, gaps = [], []
    for command in sequence:
        v, w = CONTINUOUS.velocities[command]
        turned = theta + 0.2 * w
        if w:
            x, y = x + v / w * (math.sin(turned) - math.sin(theta)), y - v / w * (math.cos(turned) - math.cos(theta))
        else:
            x, y = x + 0.2 * v * math.cos(theta), y + 0.2 * v * math.sin(theta)
        theta = turned
        expected.append((x, y, theta))
        gaps.append(gap_of((x, y)))
    commands = np.array(sequence, np.int64)
    found = predict(np.array(pose), CONTINUOUS, commands)
    np.testing.assert_allclose(found, np.array(expected).reshape(-1, 3), atol=1e-9)
    arrays = (HALL.gap, HALL.closed, HALL.frame)
    assert tightest(*arrays, np.array(pose), CONTINUOUS.moves, commands) == pytest.approx(min(gaps, default=math.inf))


def slow_lookahead(path: np.ndarray, position: Point, lookahead: float, margin: float) -> int:
    away = np.hypot(*(path - position).T)
    nearest = int(np.flatnonzero(away == away.min())[-1])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path[nearest:], axis=0).T))])
    seen = [
        nearest + k
        for k, travelled in enumerate(along)
        if travelled <= lookahead
        and (travelled <= 0.4 or in_sight(HALL, np.array(position), path[nearest + k], margin))
    ]
    return max([nearest, *seen])


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), POINT, st.sampled_from([0.5, 1.5]), st.sampled_from([0.0, 0.15]))
def test_a_lookahead_point_is_the_last_point_in_sight(
    seed: int, position: Point, lookahead: float, margin: float
) -> None:
    rng = np.random.default_rng(seed)
    path = np.cumsum(rng.normal((0.03, 0.01), 0.06, (40, 2)), axis=0) + rng.uniform((0, 0), (3, 2))
    found = lookahead_point(path, np.array(position), HALL.gap, HALL.closed, HALL.frame, lookahead, margin)
    assert found == slow_lookahead(path, position, lookahead, margin)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), POINT, st.sampled_from([0.0, 0.15, 0.3]))
def test_a_path_is_blocked_where_a_point_that_is_left_of_it_is_too_near(
    seed: int, position: Point, margin: float
) -> None:
    rng = np.random.default_rng(seed)
    path = np.cumsum(rng.normal((0.02, 0.01), 0.05, (30, 2)), axis=0) + rng.uniform((0, 0), (3, 2))
    away = np.hypot(*(path - position).T)
    rest = path[int(np.flatnonzero(away == away.min())[-1]) :]
    low, high = -RES, np.array(HALL.gap.shape[::-1]) * RES - RES
    looked_at = [p for p in rest if (p >= low).all() and (p < high).all() and math.dist(p, position) > 0.2]
    expected = any(gap_of(p) < margin for p in looked_at)
    assert blocked_ahead(path, np.array([*position, 0.0]), HALL, margin) == expected


FREE = st.tuples(st.floats(0.3, 2.7), st.floats(0.3, 1.7), TURN)


@settings(max_examples=25, deadline=None)
@given(FREE, st.tuples(st.floats(0.3, 2.7), st.floats(0.3, 1.7)), st.sampled_from([DISCRETE, CONTINUOUS]))
def test_steering_never_commands_a_collision_and_ends_where_one_can_stay(
    pose: tuple[float, float, float], target: Point, commands: Commands
) -> None:
    if gap_of(pose) < 0.2:
        return
    sequence = steer(HALL, np.array(pose), target, commands)
    if not len(sequence):
        return
    poses = predict(np.array(pose), commands, sequence)
    assert min(gap_of(at) for at in poses) >= 0.17 - 1e-9
    assert math.dist(poses[-1, :2], target) <= 0.15
    turns = [v for v in commands.velocities if v[1] != 0.0]
    assert max(loiter_gap(HALL.gap, HALL.closed, HALL.frame, poses[-1], v) for v in turns) >= 0.17
    quickest = math.ceil((math.dist(pose[:2], target) - 0.15) / 0.1 - 1e-9)  # 0.1 m a command at most
    assert len(sequence) >= max(quickest, 1)
