"""Sparse optimisation: edges that agree are met exactly, and one that lies is left aside."""

import numpy as np
import pytest

from lidarena.slam.graph.optimization import Edges, belief, joined, marginal, optimized, optimized_end, residuals
from lidarena.slam.planar import between

SQUARE = np.array(
    [[x, y, t] for x, y, t in [(0, 0, 0), (2, 0, 1.5), (2, 2, 3.1), (0, 2, -1.6), (0.0, 0.1, 0.0)]], float
)


def edges_of(poses: np.ndarray, pairs: list[tuple[int, int]], robust: float = np.inf) -> Edges:
    indices = np.array(pairs)
    motions = between(poses[indices[:, 0]], poses[indices[:, 1]])
    return Edges(indices, motions, np.broadcast_to(np.eye(3) * 100.0, (len(pairs), 3, 3)), np.full(len(pairs), robust))


CHAIN = edges_of(SQUARE, [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)])


def test_agreeing_edges_are_met_exactly() -> None:
    wrong = SQUARE + np.random.default_rng(0).normal(0.0, 0.15, SQUARE.shape)
    wrong[0] = SQUARE[0]
    found = optimized(wrong, CHAIN, 20)
    np.testing.assert_allclose(found, SQUARE, atol=1e-4)
    assert np.abs(residuals(found, CHAIN)).max() < 1e-4


def test_a_lying_loop_is_left_aside() -> None:
    lie = Edges(np.array([[0, 3]]), np.array([[5.0, 5.0, 0.0]]), np.eye(3)[None] * 100.0, np.array([10.0]))
    found = optimized(SQUARE, joined([CHAIN, lie]), 20)
    assert np.abs(found - SQUARE).max() < 0.05
    assert belief(found, lie)[0] < 0.01 and (belief(found, CHAIN) == 1.0).all()


def test_marginal_covariances_add_up_along_a_chain() -> None:
    """Poses on a line without turns: each step adds its covariance, and what a wrong heading does beyond it."""
    line = np.column_stack([np.arange(5.0), np.zeros(5), np.zeros(5)])
    edges = edges_of(line, [(k, k + 1) for k in range(4)])
    for node in (1, 2, 4):
        found = marginal(line, edges, node)
        assert found[0, 0] == pytest.approx(0.01 * node, rel=1e-3)
        assert found[2, 2] == pytest.approx(0.01 * node, rel=1e-3)
        levers = np.arange(node)  # how far behind the last pose each heading was wrong, but for the step itself
        assert found[1, 1] == pytest.approx(0.01 * node + 0.01 * np.sum(levers**2), rel=1e-3)


def test_a_loop_makes_the_far_end_more_certain() -> None:
    chain = edges_of(SQUARE, [(0, 1), (1, 2), (2, 3)])
    loop = edges_of(SQUARE, [(0, 3)])
    open_end, closed = marginal(SQUARE, chain, 3), marginal(SQUARE, joined([chain, loop]), 3)
    assert np.linalg.eigvalsh(open_end - closed).min() > 0.0


def test_the_end_alone_is_moved_where_that_is_enough() -> None:
    wrong = SQUARE.copy()
    wrong[3:] += (0.05, -0.03, 0.02)
    found, strained = optimized_end(wrong, CHAIN, 3, 10)
    assert not strained
    np.testing.assert_allclose(found, SQUARE, atol=1e-4)
    np.testing.assert_array_equal(found[:3], SQUARE[:3])


def test_an_end_that_cannot_meet_its_edges_is_told() -> None:
    wrong = SQUARE.copy()
    wrong[1:3] += (2.0, 0.0, 0.0)
    assert optimized_end(wrong, CHAIN, 3)[1]
