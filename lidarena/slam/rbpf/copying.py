"""Copying inside kernels: a plain loop compiles in milliseconds, where ``a[:] = b`` takes numba seconds."""

from typing import Any

from numpy.typing import NDArray

from lidarena.base.jit import inlined


@inlined
def copy_vector(target: NDArray[Any], source: NDArray[Any]) -> None:
    """``target[:] = source`` for vectors of one length."""
    for i in range(target.shape[0]):
        target[i] = source[i]


@inlined
def copy_matrix(target: NDArray[Any], source: NDArray[Any]) -> None:
    """``target[:] = source`` for matrices of one shape."""
    for i in range(target.shape[0]):
        for j in range(target.shape[1]):
            target[i, j] = source[i, j]
