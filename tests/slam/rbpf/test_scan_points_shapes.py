"""What is made of a scan: the outline of what it saw free, and points with normals on what it hit."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.rbpf.likelihood_field import SECTORS
from lidarena.slam.rbpf.scan_points import PointParameters, _average_hits
from tests.slam.rbpf.test_scan_matching import points_of
from tests.slam.test_scan_outline import surfaces

BEAMS, ROWS, COLUMNS, REACH = 360, 90, 100, 3.5
ANGLES = np.arange(BEAMS) * (2 * math.pi / BEAMS)
DIRECTIONS = np.stack([np.cos(ANGLES), np.sin(ANGLES)])


def slow_means(scan: np.ndarray) -> tuple[list[np.ndarray], list[int]]:
    """Runs of hits shorter than the spacing, averaged, and which unbroken surface each lies on."""
    p, means, numbers, run, number = PointParameters(), [], [], [], 0
    for k, reach in enumerate(scan.astype(float)):
        hit, place = 0.0 < reach < REACH, reach * DIRECTIONS[:, k]
        jump = bool(run) and math.dist(place, run[-1]) > p.jump
        if run and (jump or not hit or math.dist(place, run[0]) >= p.spacing):
            means.append(np.mean(run, axis=0))
            numbers.append(number)
            run = []
            number += jump or not hit
        if hit:
            run.append(place)
    return means + ([np.mean(run, axis=0)] if run else []), numbers + ([number] if run else [])


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6))
def test_hits_are_averaged_over_a_cells_side_and_surfaces_end_at_jumps(seed: int) -> None:
    scan, means, numbers = surfaces(seed), np.zeros((BEAMS, 2)), np.zeros(BEAMS, np.int64)
    count = _average_hits(scan, DIRECTIONS, REACH, PointParameters(), means, numbers)
    expected, surface = slow_means(scan)
    np.testing.assert_allclose(means[:count], expected, atol=1e-9)
    assert numbers[:count].tolist() == surface


@pytest.mark.parametrize("radius", [0.8, 1.5, 3.0])
def test_on_a_round_wall_every_normal_points_to_its_middle(radius: float) -> None:
    points, flat = points_of(np.full(BEAMS, radius, np.float32), DIRECTIONS)
    away = np.hypot(*points[:, :2].T)
    assert (away <= radius + 1e-6).all() and (away > radius - 0.01).all()
    assert flat.mean() > 0.95  # the seam may lack neighbours
    cosine = -(points[flat, :2] * points[flat, 2:4]).sum(axis=1) / away[flat]
    assert (cosine > np.cos(0.08 / radius + 0.01)).all()  # at the seam the neighbours lie on one side
    assert (cosine[5:-5] > np.cos(0.01)).all()
    np.testing.assert_allclose(points[:, 4], np.arctan2(points[:, 3], points[:, 2]) * SECTORS / (2 * np.pi))
    assert len(points) <= 2 * np.pi * radius / 0.05 + 1


def test_a_corner_has_no_normal_and_its_sides_have_theirs() -> None:
    angles = np.where(np.abs(ANGLES - math.pi / 4) < 0.6, ANGLES, np.nan)
    scan = np.nan_to_num(1.0 / np.maximum(np.cos(angles), np.sin(angles)), nan=REACH).astype(np.float32)
    points, flat = points_of(scan, DIRECTIONS)  # the walls x = 1 and y = 1
    corner = np.hypot(points[:, 0] - 1, points[:, 1] - 1)
    assert not flat[corner < 0.06].any()
    for axis in (0, 1):
        side = (points[:, axis] > 0.999) & (corner > 0.2) & flat
        assert side.sum() > 3
        np.testing.assert_allclose(points[side, 2 + axis], -1.0, atol=1e-3)


def test_a_jump_parts_two_walls_that_would_bend_each_others_normals() -> None:
    near, far = np.where(ANGLES < 0.3, 1.0, 1.6), (ANGLES < 0.6)
    scan = np.where(far, near / np.cos(ANGLES), REACH).astype(np.float32)
    points, flat = points_of(scan, DIRECTIONS)
    assert flat.sum() > 8
    np.testing.assert_allclose(points[flat, 2:4], [[-1.0, 0.0]] * int(flat.sum()), atol=1e-3)
