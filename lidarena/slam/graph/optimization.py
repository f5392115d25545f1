"""Sparse Gauss-Newton over poses that are tied to each other by measured motions (Grisetti et al. 2010)."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from lidarena.slam.planar import between, wrapped

Floats = NDArray[np.float64]

_STRAINED = 20.0, 6.0
"""Squared Mahalanobis distance from which on an edge of the way, of which there are many, and a loop are strained."""


class Edges(NamedTuple):
    """``E`` measured motions.

    Attributes:
        pairs: (E, 2) from which pose to which.
        motions: (E, 3) pose of the second seen from the first.
        information: (E, 3, 3) inverse covariances.
        robust: (E,) squared Mahalanobis distance from which on an edge is doubted (Geman-McClure); infinite: never.
    """

    pairs: NDArray[np.int64]
    motions: Floats
    information: Floats
    robust: Floats


def joined(parts: list[Edges]) -> Edges:
    """All edges of several lists."""
    return Edges(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


def residuals(poses: Floats, edges: Edges) -> Floats:
    """(E, 3) how far the poses (K, 3) are from what was measured, in the frame of the first of each pair."""
    error = between(poses[edges.pairs[:, 0]], poses[edges.pairs[:, 1]]) - edges.motions
    error[:, 2] = wrapped(error[:, 2])
    return error


def _squared(poses: Floats, edges: Edges) -> Floats:
    """(E,) squared Mahalanobis distances of the poses (K, 3) from what was measured."""
    error = residuals(poses, edges)
    squared: Floats = np.einsum("ei,eij,ej->e", error, edges.information, error)
    return squared


def belief(poses: Floats, edges: Edges) -> Floats:
    """(E,) how far each edge is believed, 0 to 1."""
    share = 1.0 / (1.0 + _squared(poses, edges) / edges.robust)
    believed: Floats = share * share
    return believed


def optimized(poses: Floats, edges: Edges, rounds: int = 5, held: int = 1, settled: float = 1e-5) -> Floats:
    """Move poses (K, 3) to where the edges fit best.

    Args:
        poses: Where they are.
        edges: What was measured.
        rounds: Steps at most.
        held: So many of the first stay where they are.
        settled: Steps that move no pose by more end the search [m, rad].
    """
    poses = poses.copy()
    for _ in range(rounds):
        step = _gauss_newton_step(poses, edges, held)
        poses += step
        if np.abs(step).max() < settled:
            break
    poses[:, 2] = wrapped(poses[:, 2])
    return poses


def optimized_end(poses: Floats, edges: Edges, first: int, rounds: int = 3) -> tuple[Floats, bool]:
    """Move the poses from ``first`` on alone, in a time that hardly depends on how many stand before.

    Returns:
        (K, 3) poses, and whether the last one's loops or the way are strained, so that the others should move, too.
    """
    touching: list[Any] = [each[(edges.pairs >= first).any(axis=1)] for each in edges]
    part = Edges(*touching)
    touched = np.unique(part.pairs[part.pairs < first])
    used = np.concatenate([touched, np.arange(first, len(poses))])
    part = part._replace(pairs=np.searchsorted(used, part.pairs))
    end = optimized(poses[used], part, rounds, len(touched))
    way = np.isinf(part.robust)
    counts = way | (part.pairs[:, 1] == len(used) - 1)
    strained = bool(np.any(counts & (_squared(end, part) > np.where(way, *_STRAINED))))
    moved = poses.copy()
    moved[first:] = end[len(touched) :]
    return moved, strained


def _gauss_newton_step(poses: Floats, edges: Edges, held: int) -> Floats:
    """(K, 3) the step that the linearised edges ask for."""
    matrix, gradient = normal_equations(poses, edges, held)
    step: Floats = _factorized(matrix).solve(-gradient.ravel()).reshape(-1, 3)
    return step


def marginal(poses: Floats, edges: Edges, node: int) -> Floats:
    """(3, 3) covariance of one pose, given all edges and that the first pose is where it is [m², m rad, rad²]."""
    matrix, _ = normal_equations(poses, edges)
    unit = np.zeros((matrix.shape[0], 3))
    unit[3 * node + np.arange(3), np.arange(3)] = 1.0
    block: Floats = _factorized(matrix).solve(unit)[3 * node : 3 * node + 3]
    return 0.5 * (block + block.T)


def _factorized(matrix: csc_matrix) -> SuperLU:
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def normal_equations(poses: Floats, edges: Edges, held: int = 1) -> tuple[csc_matrix, Floats]:
    """Information matrix (3 K, 3 K) of poses that edges tie to each other and to those held, and gradient (K, 3)."""
    i, j = edges.pairs[:, 0], edges.pairs[:, 1]
    error, moved = residuals(poses, edges), between(poses[i], poses[j])
    information = edges.information * belief(poses, edges)[:, None, None]
    cos, sin, zero = np.cos(poses[i, 2]), np.sin(poses[i, 2]), np.zeros(len(i))
    turned = np.stack([np.stack([cos, sin, zero], -1), np.stack([-sin, cos, zero], -1)], 1)
    second = np.concatenate([turned, np.broadcast_to([[[0.0, 0.0, 1.0]]], (len(i), 1, 3))], axis=1)
    first = -second
    first[:, 0, 2], first[:, 1, 2] = moved[:, 1], -moved[:, 0]
    blocks, gradient = [], np.zeros((len(poses), 3))
    for a, left in ((i, first), (j, second)):
        weighed = np.einsum("eki,ekl->eil", left, information)
        np.add.at(gradient, a, np.einsum("eil,el->ei", weighed, error))
        blocks += [(a, b, np.einsum("eil,elj->eij", weighed, right)) for b, right in ((i, first), (j, second))]
    rows = np.concatenate(
        [np.broadcast_to(3 * a[:, None, None] + np.arange(3)[:, None], m.shape) for a, _, m in blocks]
    )
    columns = np.concatenate([np.broadcast_to(3 * b[:, None, None] + np.arange(3), m.shape) for _, b, m in blocks])
    values, size = np.concatenate([m for _, _, m in blocks]), 3 * len(poses)
    anchor = np.arange(3 * held)
    matrix = coo_matrix(
        (
            np.concatenate([values.ravel(), np.full(3 * held, 1e9), np.full(size, 1e-6)]),
            (
                np.concatenate([rows.ravel(), anchor, np.arange(size)]),
                np.concatenate([columns.ravel(), anchor, np.arange(size)]),
            ),
        ),
        shape=(size, size),
    ).tocsc()
    return matrix, gradient
