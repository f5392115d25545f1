"""The three ways in which this package compiles.

numba counts references to arrays whenever one is passed to a compiled function, with atomic operations that cost more than
most of the functions here. A function that allocates nothing needs no counting (``_nrt=False``): measured on the field's
look-up, 46 ns become 11.
"""

from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit

Function = TypeVar("Function", bound=Callable[..., Any])


def kernel(function: Function) -> Function:
    """Compile a function that allocates arrays; it releases the interpreter lock and is cached on disk."""
    compiled: Function = njit(cache=True, nogil=True)(function)
    return compiled


def leaf(function: Function) -> Function:
    """Compile a function that allocates nothing, and so need not count references."""
    compiled: Function = njit(cache=True, nogil=True, _nrt=False)(function)
    return compiled


def inlined(function: Function) -> Function:
    """Compile a small ``leaf`` into each of its callers."""
    compiled: Function = njit(cache=True, nogil=True, _nrt=False, forceinline=True)(function)
    return compiled


def fast_leaf(function: Function) -> Function:
    """Compile a ``leaf`` whose sums may be reordered; NaN and infinity keep their meaning."""
    options = {"reassoc", "contract", "nsz", "arcp"}
    compiled: Function = njit(cache=True, nogil=True, _nrt=False, fastmath=options)(function)
    return compiled
