"""Sparse optimisation: edges that agree are met exactly, and one that lies is left aside."""

import numpy as np

from lidarena.slam.graph.optimization import Edges, belief, joined, optimized, residuals
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
