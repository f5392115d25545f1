import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.rbpf.likelihood_field import FULL, SIGMA, Fields, ParticleField, empty_fields
from lidarena.slam.rbpf.point_blocks import Workspace, as_blocks, empty_blocks, empty_workspaces
from lidarena.slam.rbpf.registration import register_points
from lidarena.slam.rbpf.scan_matching import MatcherParameters, _linearise, match, match_cost
from lidarena.slam.rbpf.scan_points import PointParameters, extract_points
from lidarena.slam.rbpf.symmetric import Symmetric, determinant, inverse, rotated, times
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar
from tests.slam.rbpf.dense_field import dense

ROOM = Floorplan.from_shapes(
    "room",
    (0, 0, 4, 3),
    walls=[(0, 0, 4, 0), (4, 0, 4, 3), (4, 3, 0, 3), (0, 3, 0, 0), (2.5, 1.2, 2.5, 3)],
    start=(1.2, 1.2, 0.3),
)
TRUE = np.array(ROOM.start)
WORK = Workspace(*(rows[0] for rows in empty_workspaces(1)))
ORIGIN = np.array([-1.0, -1.0])


def registered(points: np.ndarray, pose: np.ndarray) -> tuple[Fields, ParticleField]:
    """Fields of one particle that knows the points, seen from a pose; and that particle's."""
    fields = empty_fields(1, 1, 112, 512)
    register_points(fields, 0, 0, pose, ORIGIN, 0.05, as_blocks(points), WORK)
    return fields, ParticleField(fields.tiles[0].reshape(-1), fields.table[0, 0], ORIGIN, 0.05)


def scan_of(plan: Floorplan, pose: np.ndarray, noise: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    lidar = Lidar([plan])
    ranges = lidar.cast(pose[None, None], np.zeros(1, np.int64))[0, 0]
    hit = ranges < 3.5
    ranges[hit] += noise * np.random.default_rng(0).normal(size=hit.sum())
    return points_of(ranges.astype(np.float32), lidar.directions)


def points_of(scan: np.ndarray, directions: np.ndarray, first: int = 0, stride: int = 1) -> tuple:
    points, flat = empty_blocks(360), np.zeros(360, np.bool_)
    means, surface = np.zeros((360, 2)), np.zeros(360, np.int64)
    count = extract_points(scan, directions, 3.5, PointParameters(), first, stride, means, surface, points, flat)
    return points.transpose(0, 2, 1).reshape(-1, 5)[:count], flat[:count]


def packed(m: np.ndarray) -> Symmetric:
    return (m[0, 0], m[0, 1], m[0, 2], m[1, 1], m[1, 2], m[2, 2])


def unpacked(m: Symmetric) -> np.ndarray:
    a, b, c, d, e, f = m
    return np.array([[a, b, c], [b, d, e], [c, e, f]])


def matched(start: np.ndarray, information: np.ndarray, plan: Floorplan = ROOM, true: np.ndarray = TRUE) -> tuple:
    points, flat = scan_of(plan, true, 0.01)
    _, field = registered(points, true)
    pose, parameters = start.copy(), MatcherParameters(iterations=25)
    prior = (start.copy(), packed(information))
    value, posterior = match(field, as_blocks(points[flat]), WORK, parameters, *prior, pose)
    return pose, unpacked(posterior), value


@settings(max_examples=25, deadline=None)
@given(st.floats(-0.08, 0.08), st.floats(-0.08, 0.08), st.floats(-0.06, 0.06))
def test_a_displaced_pose_is_pulled_back(dx: float, dy: float, dt: float) -> None:
    pose, posterior, _ = matched(TRUE + np.array([dx, dy, dt]), np.eye(3))
    assert pose[:2] == pytest.approx(TRUE[:2], abs=0.012)
    assert pose[2] == pytest.approx(TRUE[2], abs=0.01)
    assert np.linalg.eigvalsh(posterior).min() > 0


def linearise_oracle(field: np.ndarray, points: np.ndarray, pose: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Point by point in plain Python: Σ (1 − f), its normal equations, on the field as one array with a rim of one."""
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    missed, hessian, gradient = float(len(points)), np.zeros((3, 3)), np.zeros(3)
    for x, y, normal_x, normal_y, sector in points:
        px, py = cos * x - sin * y, sin * x + cos * y
        u, v = (pose[0] + 1.0 + px) / 0.05, (pose[1] + 1.0 + py) / 0.05
        c, r = math.floor(u), math.floor(v)
        a, b = u - c - 0.5, v - r - 0.5
        window = field[r : r + 3, c : c + 3].astype(np.int64)
        apart = ((window & 15) - round(sector + pose[2] * 16 / (2 * math.pi))) % 16
        values = np.where(np.minimum(apart, 16 - apart) <= 4, window >> 4, 0) / FULL
        across, across_slope = spline_weights(a)
        along, along_slope = spline_weights(b)
        fit = along @ values @ across
        slope = np.array([along @ values @ across_slope, along_slope @ values @ across]) / 0.05
        normal = np.array([cos * normal_x - sin * normal_y, sin * normal_x + cos * normal_y])
        row = np.array([normal[0], normal[1], normal[1] * px - normal[0] * py])
        missed -= fit
        hessian += fit * np.outer(row, row)
        gradient += (SIGMA**2 + 0.25 * 0.05**2) * (slope @ normal) * row
    return missed, hessian, gradient


def spline_weights(a: float) -> tuple[np.ndarray, np.ndarray]:
    weights = np.array([0.5 * (0.5 - a) ** 2, 0.75 - a * a, 0.5 * (0.5 + a) ** 2])
    return weights, np.array([a - 0.5, -2.0 * a, a + 0.5])


@settings(max_examples=25, deadline=None)
@given(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1), st.floats(-0.2, 0.2), st.integers(1, 120))
def test_blocks_of_points_are_linearised_as_one_by_one(dx: float, dy: float, dt: float, most: int) -> None:
    points, _ = scan_of(ROOM, TRUE, 0.01)
    points = points[:most]
    fields, field = registered(points, TRUE)
    pose = TRUE + np.array([dx, dy, dt])
    missed, hessian, gradient = _linearise(field, as_blocks(points), WORK, pose)
    expected = linearise_oracle(np.pad(dense(fields, 0), 1), points, pose)
    assert missed == pytest.approx(expected[0], abs=1e-9)
    assert unpacked(hessian) == pytest.approx(expected[1], abs=1e-9)
    assert gradient == pytest.approx(expected[2], abs=1e-9)


def test_the_likelihood_prefers_the_prior_that_agrees_with_the_map() -> None:
    stiff = np.diag([1e5, 1e5, 1e5])
    here, away = matched(TRUE, stiff)[2], matched(TRUE + np.array([0.1, 0.0, 0.0]), stiff)[2]
    assert here > away


def test_a_bare_corridor_informs_across_but_hardly_along() -> None:
    walls = [(0, 0, 20, 0), (0, 1.2, 20, 1.2), (0, 0, 0, 1.2), (20, 0, 20, 1.2)]
    plan = Floorplan.from_shapes("corridor", (0, 0, 20, 1.2), walls=walls, start=(10, 0.6, 0.0))
    _, posterior, _ = matched(np.array(plan.start), np.diag([1e-6, 1e-6, 1e-6]), plan, np.array(plan.start))
    assert posterior[0, 0] < 0.02 * posterior[1, 1]


def test_normals_point_from_flat_walls_to_the_sensor() -> None:
    points, flat = scan_of(ROOM, TRUE)
    assert flat.mean() > 0.7
    facing = (points[:, :2] * points[:, 2:4]).sum(axis=1)
    assert (facing < 0).all()
    turned = np.stack([np.cos(TRUE[2]), np.sin(TRUE[2])])
    world_x = points[flat, 2] * turned[0] - points[flat, 3] * turned[1]
    world_y = points[flat, 2] * turned[1] + points[flat, 3] * turned[0]
    assert (np.maximum(np.abs(world_x), np.abs(world_y)) > 0.99).mean() > 0.95


def test_points_are_spaced_and_lie_on_the_walls() -> None:
    points, _ = scan_of(ROOM, TRUE)
    cos, sin = math.cos(TRUE[2]), math.sin(TRUE[2])
    world = TRUE[:2] + points[:, :2] @ np.array([[cos, sin], [-sin, cos]])
    assert np.abs(ROOM.clearance(world)).max() < 0.02
    apart = np.hypot(*np.diff(points[:, :2], axis=0).T)
    assert np.median(apart) > 0.03
    assert len(points) < 300


def test_a_scan_without_returns_has_no_points() -> None:
    points, _ = points_of(np.full(360, 3.5, np.float32), np.ones((2, 360)))
    assert len(points) == 0


def test_every_second_point_is_one_of_all() -> None:
    lidar = Lidar([ROOM])
    scan = lidar.cast(TRUE[None, None], np.zeros(1, np.int64))[0, 0].astype(np.float32)
    everything, flat = points_of(scan, lidar.directions)
    for first in (0, 1):
        some, some_flat = points_of(scan, lidar.directions, first, 2)
        assert np.array_equal(some, everything[first::2])
        assert np.array_equal(some_flat, flat[first::2])


@settings(max_examples=25, deadline=None)
@given(st.floats(0.05, 0.3), st.floats(-3, 3))
def test_the_match_cost_is_least_where_the_scan_was_taken(away: float, direction: float) -> None:
    points, _ = scan_of(ROOM, TRUE)
    arguments = (registered(points, TRUE)[1], as_blocks(points), WORK)
    beside = TRUE + away * np.array([math.cos(direction), math.sin(direction), 0.0])
    assert 0.0 <= match_cost(*arguments, TRUE) < match_cost(*arguments, beside) <= len(points)


@settings(deadline=None)
@given(st.lists(st.floats(-3, 3), min_size=9, max_size=9), st.lists(st.floats(-3, 3), min_size=3, max_size=3))
def test_three_by_three_algebra_agrees_with_numpy(entries: list[float], right: list[float]) -> None:
    root = np.array(entries).reshape(3, 3)
    matrix = root @ root.T + 0.1 * np.eye(3)
    m = packed(matrix)
    assert determinant(m) == pytest.approx(np.linalg.det(matrix), rel=1e-6)
    assert unpacked(inverse(m)) == pytest.approx(np.linalg.inv(matrix), rel=1e-5, abs=1e-7)
    vector = (right[0], right[1], right[2])
    assert times(m, vector) == pytest.approx(matrix @ right, rel=1e-9, abs=1e-9)
    theta = right[0]
    turn = np.array([[math.cos(theta), -math.sin(theta), 0], [math.sin(theta), math.cos(theta), 0], [0, 0, 1]])
    assert unpacked(rotated(m, theta)) == pytest.approx(turn @ matrix @ turn.T, rel=1e-9, abs=1e-9)
