"""The ways in which this package compiles.

numba counts references to arrays whenever one is passed to a compiled function, with atomic operations that cost more
than most of the functions here. A function that allocates nothing needs no counting (``_nrt=False``).

None of them lets the compiler reorder sums (``fastmath``): the process that compiled a kernel and those that load it
from the cache would then differ in the last bit.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

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


def merged(function: Callable[..., Result]) -> Callable[..., Result]:
    """Compile a large ``leaf`` only as a part of its callers, not by itself and then again with each of them."""
    compiled: Callable[..., Result] = njit(**_LEAF, inline="always")(function)
    return compiled


def _take_next(context: Any, counter: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = context.make_array(signature.args[0])(context, builder, arguments[0])
        return builder.atomic_rmw("add", array.data, cgutils.intp_t(1), "monotonic")

    return types.intp(counter), generate


take_next = cast(Callable[[NDArray[np.int64]], int], intrinsic(_take_next))
"""``counter[0]`` of a counter (1,), raised atomically by one: threads that share it never get the same number.
Within kernels only."""
