"""Maps of ROS ``map_server``: a YAML file with a PGM or PNG picture beside it, read and written."""

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.base.files import write_bytes
from lidarena.world.extent import MAX_DRAWN_CELLS, check_extent, check_resolution
from lidarena.world.picture import read_picture

FREE_THRESH, OCCUPIED_THRESH = 0.196, 0.65
"""What the map savers write, and what is taken where a YAML file names no threshold."""
FREE_GREY, UNKNOWN_GREY, OCCUPIED_GREY = 254, 205, 0
"""The grey values that the map savers write."""

_STANDS_OUT, _NEIGHBOURS, _FEWEST = 3, 3, 50
"""A grey is a code if it is so many times as frequent as the greys that differ by up to so much, together, and if so
many pixels have it."""

_KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")
_REQUIRED = ("image", "resolution", "origin")

Pose = tuple[float, float, float]


@dataclass(frozen=True)
class OccupancyMap:
    """An occupancy grid in the world.

    Attributes:
        occupancy: int8 ``[row, column]``, row 0 at the smallest y: -1 unknown, 0 free, 100 occupied.
        resolution: Side of a cell [m].
        origin: Pose of the lower-left corner of cell [0, 0] as x, y, yaw [m, m, rad].
    """

    occupancy: NDArray[np.int8]
    resolution: float
    origin: Pose

    @property
    def solid(self) -> NDArray[np.bool_]:
        """Where no robot may be: every cell that is occupied or unknown."""
        solid: NDArray[np.bool_] = self.occupancy != 0
        return solid


@dataclass(frozen=True)
class MapDescription:
    """The YAML half of a map: where its picture is, and how ``load_map`` reads it."""

    image: Path
    resolution: float
    origin: Pose
    negate: bool
    occupied_thresh: float
    free_thresh: float


def load_map(path: str | os.PathLike[str]) -> OccupancyMap:
    """Load a ``map_server`` map in trinary mode.

    A pixel v has the occupancy p = (255 - v) / 255, or v / 255 with ``negate``; p > ``occupied_thresh`` is occupied,
    p < ``free_thresh`` free, all else unknown. Transparent pixels are unknown. In a picture that has the savers' own
    grey for free cells (254), or in which 205 stands out among its neighbouring greys, 205 is unknown whatever the
    threshold: some savers print a ``free_thresh`` of 0.25 beside it, by which all unmapped surroundings (p = 0.196)
    would read as free, though someone drew a line of another grey into it.

    Args:
        path: The YAML file.

    Raises:
        MapError: A file is missing or torn, or a value is out of range.
    """
    description = read_description(path)
    where = f"map {os.fspath(path)!r}"
    grey, transparent = read_picture(description.image, where, description.resolution)
    p = grey / 255 if description.negate else (255 - grey) / 255
    occupancy = np.full(grey.shape, -1, dtype=np.int8)
    occupancy[p < description.free_thresh] = 0
    occupancy[p > description.occupied_thresh] = 100
    if not description.negate and (np.any(grey == FREE_GREY) or _is_code(grey)):
        occupancy[grey == UNKNOWN_GREY] = -1
    occupancy[transparent] = -1
    return OccupancyMap(occupancy[::-1].copy(), description.resolution, description.origin)


def _is_code(grey: NDArray[np.float64]) -> bool:
    """Whether the savers' grey for unknown cells was meant as such: shades do not stand out among their neighbours."""
    unknown = int(np.sum(grey == UNKNOWN_GREY))
    return unknown >= _FEWEST and unknown > _STANDS_OUT * int(
        np.sum((np.abs(grey - UNKNOWN_GREY) <= _NEIGHBOURS) & (grey != UNKNOWN_GREY))
    )


def read_description(path: str | os.PathLike[str]) -> MapDescription:
    """Read and check the YAML half of a map.

    Raises:
        MapError: The file is missing or malformed, or a value is out of range.
    """
    file = Path(path)
    where = f"map {str(file)!r}"
    entries = _read_yaml(file, where)
    _check_keys(entries, where)
    mode = entries.get("mode", "trinary")
    if mode != "trinary":
        raise MapError(f"{where} has mode {mode!r}; only 'trinary' is read, so save or thresh it that way")
    image = entries["image"]
    if not isinstance(image, str) or not image or "\0" in image:
        raise MapError(f"{where} has image {image!r}; the name of a PGM or PNG file is needed")
    free = _number(entries.get("free_thresh", FREE_THRESH), f"{where} has free_thresh")
    occupied = _number(entries.get("occupied_thresh", OCCUPIED_THRESH), f"{where} has occupied_thresh")
    if not 0 <= free <= occupied <= 1:
        raise MapError(
            f"{where} has free_thresh {free:g} and occupied_thresh {occupied:g}; 0 <= free <= occupied <= 1 is needed"
        )
    negate = entries.get("negate", 0)
    if negate not in (0, 1):
        raise MapError(f"{where} has negate {negate!r}; 0 or 1 is allowed")
    resolution = check_resolution(where, _number(entries["resolution"], f"{where} has resolution"))
    origin = _origin(entries["origin"], where)
    return MapDescription(file.parent / image, resolution, origin, bool(negate), occupied, free)


def save_map(
    path: str | os.PathLike[str],
    occupancy: NDArray[np.int8],
    resolution: float,
    origin: tuple[float, float] | Pose = (0.0, 0.0, 0.0),
) -> Path:
    """Write a grid as ROS's map savers do: a binary PGM of 0, 205, 254 and a YAML file beside it.

    Occupancies from 65 on are written as occupied, 0 to 25 as free, the others as unknown.

    Args:
        path: Where to; ``.yaml``, ``.pgm`` or no ending, the two files get theirs.
        occupancy: ``[row, column]``, row 0 at the smallest y: -1 unknown, 0 free … 100 occupied.
        resolution: Side of a cell [m].
        origin: x, y and, if not zero, yaw of the lower-left corner of cell [0, 0] [m, m, rad].

    Returns:
        The YAML file.

    Raises:
        MapError: The grid is no grid of occupancies, or resolution or origin are out of range.
    """
    grid = np.asarray(occupancy)
    where = f"the grid for {os.fspath(path)!r}"
    if grid.ndim != 2 or not np.issubdtype(grid.dtype, np.integer) or not grid.size:
        raise MapError(f"{where} has shape {grid.shape} of {grid.dtype}; a 2-D array of integers is needed")
    if grid.min() < -1 or grid.max() > 100:
        raise MapError(f"{where} holds {grid.min()} to {grid.max()}; -1 (unknown) to 100 (occupied) are allowed")
    check_extent(where, grid.shape[0], grid.shape[1], check_resolution(where, resolution), MAX_DRAWN_CELLS)
    pose = _origin([*origin] if len(origin) == 3 else [*origin, 0.0], where)
    base = Path(path)
    base = base.with_suffix("") if base.suffix in (".yaml", ".yml", ".pgm") else base
    picture, description = base.with_name(base.name + ".pgm"), base.with_name(base.name + ".yaml")
    grey = np.full(grid.shape, UNKNOWN_GREY, dtype=np.uint8)
    grey[(grid >= 0) & (grid <= 25)] = FREE_GREY
    grey[grid >= 65] = OCCUPIED_GREY
    header = f"P5\n{grid.shape[1]} {grid.shape[0]}\n255\n".encode()
    write_bytes(picture, header + grey[::-1].tobytes())
    entries = {
        "image": picture.name,
        "mode": "trinary",
        "resolution": float(resolution),
        "origin": list(pose),
        "negate": 0,
        "occupied_thresh": OCCUPIED_THRESH,
        "free_thresh": FREE_THRESH,
    }
    write_bytes(
        description, yaml.safe_dump(entries, sort_keys=False, default_flow_style=None, allow_unicode=True).encode()
    )
    return description


def _read_yaml(file: Path, where: str) -> Mapping[Any, Any]:
    try:
        text = file.read_text(encoding="utf-8")
        entries, root = yaml.safe_load(text), yaml.compose(text, yaml.SafeLoader)
    except OSError as error:
        raise MapError(f"{where} cannot be read: {error.strerror}") from error
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        line = f" in line {mark.line + 1}" if mark else ""
        raise MapError(f"{where} is not YAML text: it cannot be understood{line}") from error
    if not isinstance(entries, dict):
        raise MapError(f"{where} holds no keys; {', '.join(_REQUIRED)} are needed")
    keys = [key.value for key, _ in root.value] if isinstance(root, yaml.MappingNode) else []
    if twice := sorted({str(key) for key in keys if keys.count(key) > 1}):
        raise MapError(f"{where} has the key {twice[0]!r} twice; each may stand there once")
    return entries


def _check_keys(entries: Mapping[Any, Any], where: str) -> None:
    """Refuse misspelt and missing keys; like ``map_server``, leave foreign ones alone."""
    absent = [key for key in _KEYS if key not in entries]
    for key in entries:
        if key not in _KEYS and (near := get_close_matches(str(key), absent, n=1, cutoff=0.75)):
            raise MapError(f"{where} has the key {key!r}; did you mean {near[0]!r}?")
    if missing := [key for key in _REQUIRED if key in absent]:
        raise MapError(f"{where} has no key {missing[0]!r}; {', '.join(_REQUIRED)} are needed")


def _number(value: object, having: str) -> float:
    try:
        if isinstance(value, str | int | float) and not isinstance(value, bool):
            return float(value)  # PyYAML takes 5e-2 for text
    except (ValueError, OverflowError):
        pass
    raise MapError(f"{having} {value!r}; a number is needed")


def _origin(value: object, where: str) -> Pose:
    if not isinstance(value, list) or len(value) != 3:
        raise MapError(f"{where} has origin {value!r}; a list of x, y (metres) and yaw (radians) is needed")
    x, y, yaw = (_number(part, f"{where} has in its origin") for part in value)
    if not all(math.isfinite(part) and abs(part) < 1e6 for part in (x, y, yaw)):
        raise MapError(f"{where} has origin {value!r}; finite numbers below a million are needed")
    return (x, y, yaw)
