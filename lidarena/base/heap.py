"""An indexed binary heap for numba kernels: the open list of best-first searches.

Items are the integers 0 .. n-1. The caller owns the arrays, so that a kernel allocates them once:

- ``heap`` (n,) integers: the items, ``heap[0]`` the one with the smallest key;
- ``where`` (n,) integers: an item's position in ``heap``, -1 while it is not in it;
- ``keys`` (n,) numbers: an item's key, written by the caller before :func:`push`.

Equal keys come out in an order that depends on the pushes alone, so a search is deterministic.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined

Ints: TypeAlias = NDArray[np.int32] | NDArray[np.int64]
Keys: TypeAlias = NDArray[np.int64] | NDArray[np.float64]


@inlined
def _rise(heap: Ints, where: Ints, keys: Keys, at: int) -> None:
    item = heap[at]
    while at > 0:
        above = (at - 1) >> 1
        if keys[heap[above]] <= keys[item]:
            break
        heap[at] = heap[above]
        where[heap[at]] = at
        at = above
    heap[at] = item
    where[item] = at


@inlined
def _sink(heap: Ints, where: Ints, keys: Keys, size: int) -> None:
    item, at = heap[0], 0
    while True:
        below = 2 * at + 1
        if below >= size:
            break
        if below + 1 < size and keys[heap[below + 1]] < keys[heap[below]]:
            below += 1
        if keys[heap[below]] >= keys[item]:
            break
        heap[at] = heap[below]
        where[heap[at]] = at
        at = below
    heap[at] = item
    where[item] = at


@inlined
def push(heap: Ints, where: Ints, keys: Keys, size: int, item: int) -> int:
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


@inlined
def pop(heap: Ints, where: Ints, keys: Keys, size: int) -> int:
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
