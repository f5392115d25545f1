"""The ways in which this package compiles.

numba counts references to arrays whenever one is passed to a compiled function, with atomic operations that cost more
than most of the functions here. A function that allocates nothing needs no counting (``_nrt=False``).

None of them lets the compiler reorder sums (``fastmath``): the process that compiled a kernel and those that load it
from the cache would then differ in the last bit.
"""

from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit

Result = TypeVar("Result")

_KERNEL: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
_LEAF: dict[str, Any] = {**_KERNEL, "_nrt": False}

# The types keep what a function returns, not what it takes: numba casts where mypy would refuse np.int64 for int.


def kernel(function: Callable[..., Result]) -> Callable[..., Result]:
    """Compile a function that allocates arrays; it releases the interpreter lock and is cached on disk."""
    compiled: Callable[..., Result] = njit(**_KERNEL)(function)
    return compiled


def leaf(function: Callable[..., Result]) -> Callable[..., Result]:
    """Compile a function that allocates nothing, and so need not count references."""
    compiled: Callable[..., Result] = njit(**_LEAF)(function)
    return compiled


def inlined(function: Callable[..., Result]) -> Callable[..., Result]:
    """Compile a small ``leaf`` into each of its callers."""
    compiled: Callable[..., Result] = njit(**_LEAF, forceinline=True)(function)
    return compiled
