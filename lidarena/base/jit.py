"""The ways in which this package compiles.

numba counts references to arrays whenever one is passed to a compiled function, with atomic operations that cost more
than most of the functions here. A function that allocates nothing needs no counting (``_nrt=False``).

None of them lets the compiler reorder sums (``fastmath``): the process that compiled a kernel and those that load it
from the cache would then differ in the last bit.
"""

import os
import tempfile
import warnings
from collections.abc import Callable
from functools import cache
from getpass import getuser
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from numba import config, njit, typeof, types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

Result = TypeVar("Result")

_KERNEL: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
_LEAF: dict[str, Any] = {**_KERNEL, "_nrt": False}

# The types keep what a function returns, not what it takes: numba casts where mypy would refuse np.int64 for int.


def kernel(function: Callable[..., Result]) -> Callable[..., Result]:
    """Compile a function that allocates arrays; it releases the interpreter lock and is cached on disk."""
    return _compiled(function, _KERNEL)


def leaf(function: Callable[..., Result]) -> Callable[..., Result]:
    """Compile a function that allocates nothing, and so need not count references."""
    return _compiled(function, _LEAF)


def inlined(function: Callable[..., Result]) -> Callable[..., Result]:
    """Compile a small ``leaf`` into each of its callers."""
    return _compiled(function, {**_LEAF, "forceinline": True})


def merged(function: Callable[..., Result]) -> Callable[..., Result]:
    """Compile a large ``leaf`` only as a part of its callers, not by itself and then again with each of them."""
    return _compiled(function, {**_LEAF, "inline": "always"})


def merged_kernel(function: Callable[..., Result]) -> Callable[..., Result]:
    """The same for a ``kernel``; for those that are handed tuples of many arrays, which cost seconds to pass on."""
    return _compiled(function, {**_KERNEL, "inline": "always"})


def entry_point(function: Callable[..., Result], *arguments: Any) -> Callable[..., Result]:
    """Compile a kernel for arguments of these types; returns what calls it without asking for their types again.

    numba looks at every array in every tuple on each call, which takes longer than a step of a single world does in
    some kernels. Whoever calls what is returned must hand over arguments of the very same types, layout of arrays
    included: nothing is checked any more.
    """
    dispatcher, type_of = cast(Any, function), cast(Callable[[Any], Any], typeof)
    signature = tuple(type_of(argument) for argument in arguments)
    dispatcher.compile(signature)
    return cast(Callable[..., Result], dispatcher.get_overload(signature))


def _compiled(function: Callable[..., Result], options: dict[str, Any]) -> Callable[..., Result]:
    """Compile, with numba's cache beside the source, else in the user's folder, else in a temporary one.

    Without the last, nothing could be imported where the package and the home cannot be written to.
    """

    def decorate(**more: Any) -> Callable[..., Result]:
        compiled: Callable[..., Result] = _with_plain_types(njit(**options | more)(function))
        return compiled

    try:
        return decorate()
    except RuntimeError as error:
        if "no locator available" not in str(error):
            raise
    return decorate() if _use_temporary_cache() else decorate(cache=False)


def _with_plain_types(compiled: Any) -> Any:
    """Compile calls with constants as calls with numbers: numba compiles a function anew for every constant passed."""
    resolve = compiled.get_call_template
    plain: Callable[[Any], Any] = types.unliteral

    def call_template(args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
        return resolve(tuple(plain(a) for a in args), {name: plain(a) for name, a in kws.items()})

    compiled.get_call_template = call_template
    return compiled


@cache
def _use_temporary_cache() -> bool:
    """Let numba, here and in processes started from here, keep its cache in a temporary folder of this user's own."""
    folder = Path(tempfile.gettempdir()) / f"lidarena-kernels-{getuser()}"
    usable = _is_own(folder)
    warnings.warn(
        "compiled kernels can be kept neither beside the package nor in the home folder; "
        + (f"they are kept in {folder}" if usable else "every process compiles them anew, which takes a minute")
        + ". Set NUMBA_CACHE_DIR to a folder that can be written to",
        stacklevel=2,
    )
    if usable:
        os.environ["NUMBA_CACHE_DIR"] = str(folder)
        setattr(config, "CACHE_DIR", str(folder))  # noqa: B010 - numba declares none of its settings
    return usable


def _is_own(folder: Path) -> bool:
    """Make a folder that nobody else can write to; False where it cannot be made, or is somebody else's."""
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.stat()
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return not hasattr(os, "getuid") or (found.st_uid == os.getuid() and not found.st_mode & 0o022)


def _take_next(context: Any, counter: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = context.make_array(signature.args[0])(context, builder, arguments[0])
        return builder.atomic_rmw("add", array.data, cgutils.intp_t(1), "monotonic")

    return types.intp(counter), generate


take_next = cast(Callable[[NDArray[np.int64]], int], intrinsic(_take_next))
"""``counter[0]`` of a counter (1,), raised atomically by one: threads that share it never get the same number.
Within kernels only."""
