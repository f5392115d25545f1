"""Periodic grids of the seabed as kernels read them: heights, and texture at ever coarser levels."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf

_SMALLEST = 8
"""Side of the coarsest level of a texture [texels]."""
_ONE = np.uint64(1)
"""Cells are counted without a sign: an index that might be negative costs a comparison."""


class HeightGrid(NamedTuple):
    """A periodic height field.

    Attributes:
        relief: (n, n, 2) float32, n a power of two: height [m] and shade at the corners of cells, ``[y, x]``.
        density: Cells a metre.
    """

    relief: NDArray[np.float32]
    density: float


class TextureTile(NamedTuple):
    """A periodic texture and its means over squares of 2, 4, 8, … texels, one level behind the other.

    Attributes:
        texels: All levels, row by row.
        first: (levels,) where each begins.
        size: Side of the finest level, a power of two [texels].
        texel: Side of its texels [m].
        density: (levels,) texels a metre of each level.
    """

    texels: NDArray[np.uint8]
    first: NDArray[np.int64]
    size: int
    texel: float
    density: NDArray[np.float64]


def mip_chain(grey: NDArray[np.float64], texel: float) -> TextureTile:
    """Make a texture of greys (n, n), n a power of two, with texels of side ``texel`` [m]."""
    levels, level = [], np.clip(grey, 0.0, 255.0)
    while len(level) >= _SMALLEST:
        levels.append(np.rint(level).astype(np.uint8).ravel())
        level = 0.25 * (level[::2, ::2] + level[1::2, ::2] + level[::2, 1::2] + level[1::2, 1::2])
    first = np.cumsum([0, *(len(one) for one in levels[:-1])]).astype(np.int64)
    density = (1.0 / (texel * 2.0 ** np.arange(len(levels)))).astype(np.float64)
    return TextureTile(np.concatenate(levels), first, len(grey), texel, density)


@inlined
def surface(grid: HeightGrid, x: float, y: float) -> tuple[float, float, float, float]:
    """Height [m], its slopes along x and y, and the shade at a point, bilinear in the cell."""
    relief, mask = grid.relief, np.uint64(grid.relief.shape[0] - 1)
    across, up = x * grid.density, y * grid.density
    column, row = math.floor(across), math.floor(up)
    a, b = across - column, up - row
    j, i = np.uint64(np.int64(column)) & mask, np.uint64(np.int64(row)) & mask
    k, l = (j + _ONE) & mask, (i + _ONE) & mask  # noqa: E741 - the cell's other corner
    h00, h01, h10, h11 = (
        float(relief[i, j, 0]), float(relief[i, k, 0]), float(relief[l, j, 0]), float(relief[l, k, 0])
    )  # fmt: skip
    bottom, top = h00 + a * (h01 - h00), h10 + a * (h11 - h10)
    slope_x = ((1.0 - b) * (h01 - h00) + b * (h11 - h10)) * grid.density
    s0 = relief[i, j, 1] + a * (relief[i, k, 1] - relief[i, j, 1])
    s1 = relief[l, j, 1] + a * (relief[l, k, 1] - relief[l, j, 1])
    return bottom + b * (top - bottom), slope_x, (top - bottom) * grid.density, s0 + b * (s1 - s0)


@leaf
def height_at(grid: HeightGrid, x: float, y: float) -> float:
    """Height of the seabed at a point [m]."""
    height, _, _, _ = surface(grid, x, y)
    return height


@inlined
def texture_at(tile: TextureTile, x: float, y: float, level: int) -> np.float32:
    """Grey of one level of a texture at a point [m], bilinear between the centres of its texels."""
    size = np.uint64(tile.size >> level)
    mask = size - _ONE
    density = tile.density[level]
    across, up = x * density - 0.5, y * density - 0.5
    column, row = math.floor(across), math.floor(up)
    a, b = np.float32(across - column), np.float32(up - row)
    j, i = np.uint64(np.int64(column)) & mask, np.uint64(np.int64(row)) & mask
    k, l = (j + _ONE) & mask, (i + _ONE) & mask  # noqa: E741
    first, texels = np.uint64(tile.first[level]), tile.texels
    t00, t01 = np.float32(texels[first + i * size + j]), np.float32(texels[first + i * size + k])
    t10, t11 = np.float32(texels[first + l * size + j]), np.float32(texels[first + l * size + k])
    bottom, top = t00 + a * (t01 - t00), t10 + a * (t11 - t10)
    grey: np.float32 = bottom + b * (top - bottom)
    return grey


@inlined
def blended_texture(tile: TextureTile, x: float, y: float, lod: float) -> np.float32:
    """Grey of a texture at a point, between the two levels around ``lod``, the binary logarithm of texels a pixel."""
    last = tile.first.shape[0] - 1
    if lod <= 0.0:
        return texture_at(tile, x, y, 0)
    level = int(lod)
    if level >= last:
        return texture_at(tile, x, y, last)
    share = np.float32(lod - level)
    finer = texture_at(tile, x, y, level)
    grey: np.float32 = finer + share * (texture_at(tile, x, y, level + 1) - finer)
    return grey
