"""The BARN worlds (Perille et al. 2020, Benchmarking Metric Ground Navigation), as cylinders."""

import io
import os
import zipfile
import zlib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError

START, GOAL = (-2.25, 3.0), (-2.25, 13.0)
"""Of every world [m]."""
ROBOT_RADIUS = 0.215
"""Of a disc in place of the benchmark's Jackal [m]."""
BOUNDS = (-4.5, 0.0, 0.0, 14.5)
"""Side walls and back wall of the worlds, and room beyond the goal [m]."""
_CELL, _ORIGIN = 0.15, (-4.575, 5.075)
_NEEDED = ("world", "xyr", "offset", "path_rc", "path_offset")


class BarnWorld(NamedTuple):
    """One world.

    Attributes:
        number: Its number in the benchmark.
        circles: Cylinders, ``(K, 3)`` as x, y, radius [m].
        reference: The benchmark's reference path with the start before and the goal behind it, ``(P, 2)`` [m].
    """

    number: int
    circles: NDArray[np.float64]
    reference: NDArray[np.float64]


def barn_indices(path: str | os.PathLike[str]) -> list[int]:
    """Return the numbers of the worlds in a file, see :func:`load_barn`."""
    return [int(index) for index in _read(path)["world"]]


def load_barn(index: int, path: str | os.PathLike[str]) -> BarnWorld:
    """Read a world from an ``.npz`` file.

    Args:
        index: Number of the world in the benchmark.
        path: A file with ``world`` (W,) numbers; ``xyr`` (n, 3) cylinders and ``path_rc`` (m, 2) cells of the reference
            paths, sliced by ``offset`` and ``path_offset`` (W + 1,).

    Raises:
        MapError: The file is missing or torn, or has no such world.
    """
    arrays = _read(path)
    found = np.flatnonzero(arrays["world"] == index)
    if not len(found):
        have = arrays["world"]
        raise MapError(
            f"world {index} is not in BARN file {os.fspath(path)!r}, which has {len(have)} worlds "
            f"from {have.min()} to {have.max()}" + (", the even numbers" if not np.any(have % 2) else "")
        )
    at = int(found[0])
    circles = arrays["xyr"][arrays["offset"][at] : arrays["offset"][at + 1]].astype(np.float64)
    cells = arrays["path_rc"][arrays["path_offset"][at] : arrays["path_offset"][at + 1]].astype(np.float64)
    reference = np.vstack([np.array(START), cells * _CELL + np.array(_ORIGIN), np.array(GOAL)])
    return BarnWorld(int(index), circles, reference)


def _read(path: str | os.PathLike[str]) -> dict[str, NDArray[Any]]:
    where = f"BARN file {os.fspath(path)!r}"
    try:
        with zipfile.ZipFile(io.BytesIO(Path(path).read_bytes())) as file:
            arrays = {name: _array(file.read(f"{name}.npy")) for name in _NEEDED}
    except FileNotFoundError as error:
        raise MapError(f"{where} is not there") from error
    except KeyError as error:
        raise MapError(f"{where} is torn or no BARN file; it needs the arrays {', '.join(_NEEDED)}") from error
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error, NotImplementedError) as error:
        raise MapError(f"{where} is torn or no .npz file: {error}") from error
    _check(where, arrays)
    return arrays


def _array(content: bytes) -> NDArray[Any]:
    array: NDArray[Any] = np.lib.format.read_array(io.BytesIO(content), allow_pickle=False)
    return array


def _check(where: str, arrays: dict[str, NDArray[Any]]) -> None:
    worlds = len(arrays["world"]) if arrays["world"].ndim == 1 else 0
    for rows, offsets, width in (("xyr", "offset", 3), ("path_rc", "path_offset", 2)):
        table, cuts = arrays[rows], arrays[offsets]
        fits = table.ndim == 2 and table.shape[1] == width and cuts.shape == (worlds + 1,) and worlds > 0
        if not fits or cuts[0] != 0 or cuts[-1] != len(table) or np.any(np.diff(cuts) < 0):
            raise MapError(f"{where} is torn: {rows} {table.shape} and {offsets} {cuts.shape} do not fit its worlds")
        if not np.isfinite(table.astype(np.float64)).all():
            raise MapError(f"{where} is torn: {rows} holds a number that is not finite")
    if not arrays["xyr"][:, 2].min() >= 0:
        raise MapError(f"{where} is torn: a radius is negative")
