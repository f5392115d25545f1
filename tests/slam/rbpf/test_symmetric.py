import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from lidarena.slam.rbpf import symmetric

SEEDS = st.integers(0, 10**6)


@njit
def compiled(m: np.ndarray, v: np.ndarray, theta: float) -> tuple:
    """The functions are made for kernels, which inline them."""
    numbers = symmetric.load(m, 0.0)
    turned, inverted = symmetric.rotated(numbers, theta), symmetric.inverse(numbers)
    return symmetric.determinant(numbers), inverted, symmetric.times(numbers, (v[0], v[1], v[2])), turned


def full(m: tuple[float, ...]) -> np.ndarray:
    a, b, c, d, e, f = m
    return np.array([[a, b, c], [b, d, e], [c, e, f]])


def positive(seed: int) -> np.ndarray:
    root = np.random.default_rng(seed).normal(size=(3, 3))
    return root @ root.T + 0.1 * np.eye(3)


@settings(max_examples=40, deadline=None)
@given(SEEDS, st.floats(-3.1, 3.1))
def test_six_numbers_do_what_matrices_do(seed: int, theta: float) -> None:
    m, v = positive(seed), np.random.default_rng(seed + 1).normal(size=3)
    determinant, inverse, product, turned = compiled(m, v, theta)
    assert determinant == pytest.approx(np.linalg.det(m), rel=1e-9)
    np.testing.assert_allclose(full(inverse), np.linalg.inv(m), rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(product, m @ v, rtol=1e-9, atol=1e-9)
    turn = np.array([[math.cos(theta), -math.sin(theta), 0], [math.sin(theta), math.cos(theta), 0], [0, 0, 1]])
    np.testing.assert_allclose(full(turned), turn @ m @ turn.T, rtol=1e-9, atol=1e-9)


def test_a_singular_matrix_has_a_determinant_above_zero() -> None:
    assert symmetric.determinant((0.0,) * 6) > 0.0


def test_loading_adds_to_the_diagonal() -> None:
    np.testing.assert_array_equal(full(symmetric.load(positive(1), 0.5)), positive(1) + 0.5 * np.eye(3))
