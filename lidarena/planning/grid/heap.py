"""An indexed binary heap for numba kernels: the open list of every best-first search in this room.

Items are the integers 0 .. n-1. The caller owns the arrays, so that a kernel allocates them once:

- ``heap`` (n,) int64: the items, ``heap[0]`` the one with the smallest key;
- ``where`` (n,) int64: an item's position in ``heap``, -1 while it is not in it;
- ``keys`` (n,) float64: an item's key, written by the caller before :func:`push`.

Equal keys come out in an order that depends on the pushes alone, so a search is deterministic.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel


@kernel
def _rise(heap: NDArray[np.int64], where: NDArray[np.int64], keys: NDArray[np.float64], i: int) -> None:
    item = heap[i]
    while i > 0:
        above = (i - 1) // 2
        if keys[heap[above]] <= keys[item]:
            break
        heap[i] = heap[above]
        where[heap[i]] = i
        i = above
    heap[i] = item
    where[item] = i


@kernel
def _sink(heap: NDArray[np.int64], where: NDArray[np.int64], keys: NDArray[np.float64], size: int) -> None:
    item = heap[0]
    i = 0
    while 2 * i + 1 < size:
        below = 2 * i + 1
        if below + 1 < size and keys[heap[below + 1]] < keys[heap[below]]:
            below += 1
        if keys[heap[below]] >= keys[item]:
            break
        heap[i] = heap[below]
        where[heap[i]] = i
        i = below
    heap[i] = item
    where[item] = i


@kernel
def push(heap: NDArray[np.int64], where: NDArray[np.int64], keys: NDArray[np.float64], size: int, item: int) -> int:
    """Insert ``item``, or move it up after its key has become smaller.

    Args:
        heap: The items, (n,).
        where: Positions of the items, (n,).
        keys: Keys of the items, (n,).
        size: How many items are in the heap.
        item: The item, its key already in ``keys``.

    Returns:
        The new size.
    """
    if where[item] < 0:
        heap[size] = item
        where[item] = size
        size += 1
    _rise(heap, where, keys, where[item])
    return size


@kernel
def pop(heap: NDArray[np.int64], where: NDArray[np.int64], keys: NDArray[np.float64], size: int) -> int:
    """Take the item with the smallest key out; the heap is then one smaller and must not have been empty.

    Args:
        heap: The items, (n,).
        where: Positions of the items, (n,).
        keys: Keys of the items, (n,).
        size: How many items are in the heap before the call.

    Returns:
        The item.
    """
    item = int(heap[0])
    where[item] = -1
    if size > 1:
        heap[0] = heap[size - 1]
        _sink(heap, where, keys, size - 1)
    return item
