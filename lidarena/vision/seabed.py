"""A virtual seabed: relief and texture without end, from a seed."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from lidarena.base.keyword_checks import check_range
from lidarena.vision.texture import HeightGrid, TextureTile, height_at, mip_chain

Floats = NDArray[np.float64]

_CELLS, _CELL = 1024, 0.125
"""The relief repeats after 128 m."""
_SAND, _GRAIN = 2048, 0.006
"""The texture's tile and its texel [m]; it repeats after 12.3 m, the shade on it does not."""
_FINE, _FINE_GRAIN = 1024, 0.0017
"""The same of the finest texture, which is seen from nearby only."""
_LIGHT = np.array([-0.45, 0.35, 1.0])
"""Where the light comes from; it does not move, or shadows would seem to be features."""


@dataclass(frozen=True)
class Seabed:
    """A height field over the plane, with texture; x, y horizontal, z up.

    Attributes:
        relief: (n, n, 2) float32 height [m] and shade of the periodic grid.
        sand: Texture.
        fine: Finest texture.
    """

    relief: NDArray[np.float32]
    sand: TextureTile
    fine: TextureTile

    @cached_property
    def grid(self) -> HeightGrid:
        """The relief as kernels take it."""
        return HeightGrid(self.relief, 1.0 / _CELL)

    def height(self, x: float, y: float) -> float:
        """Height of the seabed at a point [m]."""
        return float(height_at(self.grid, x, y))


def make_seabed(
    rng: np.random.Generator, relief: float, area: tuple[float, float, float, float], longest: float = 40.0
) -> Seabed:
    """Draw a seabed.

    Args:
        rng: Everything is drawn from it.
        relief: Difference between the highest and the lowest point of ``area`` [m].
        area: x_min, y_min, x_max, y_max where the highest point has height 0 and the lowest -``relief`` [m]; its sides
            are shorter than 128 m.
        longest: Longest wavelength of the relief [m].

    Raises:
        ConfigError: A number out of range.
    """
    check_range("relief", relief, 0.0, 50.0)
    check_range("longest", longest, 1.0, 128.0)
    heights = _fractal(rng, _CELLS, 2.3, _CELLS * _CELL / longest, _CELLS * _CELL / 0.6)
    inside = heights[np.ix_(*(_cells_between(area[axis], area[axis + 2]) for axis in (1, 0)))]
    low, high = float(inside.min()), float(inside.max())
    heights = (heights - high) * (relief / max(high - low, 1e-9))
    shade = _shade(heights) * (1.0 + 0.10 * _fractal(rng, _CELLS, 1.2, 4.0, 400.0))
    grid = np.stack([heights, np.clip(shade, 0.2, 1.6)], axis=2).astype(np.float32)
    return Seabed(grid, _sand(rng), _grains(rng))


def _cells_between(low: float, high: float) -> NDArray[np.int64]:
    first, last = math.floor(low / _CELL), math.ceil(high / _CELL)
    return np.arange(first, min(last, first + _CELLS - 1) + 1) % _CELLS


def _fractal(rng: np.random.Generator, size: int, fall: float, low: float, high: float) -> Floats:
    """Periodic noise (size, size) of mean 0 and deviation 1 with power between two frequencies [cycles a tile]."""
    rows, columns = fft.fftfreq(size) * size, fft.rfftfreq(size) * size
    waves = np.hypot(rows[:, None], columns[None, :]).astype(np.float32)
    shape = np.zeros_like(waves)
    band = (waves >= low) & (waves <= high)
    shape[band] = waves[band] ** -fall
    noise = fft.irfft2(fft.rfft2(rng.standard_normal((size, size), np.float32)) * shape, s=(size, size))
    made: Floats = (noise / noise.std()).astype(np.float64)
    return made


def _shade(heights: Floats) -> Floats:
    """Brightness of matt ground under a light from far away, 1 where it is level."""
    slope_y = (np.roll(heights, -1, 0) - np.roll(heights, 1, 0)) / (2.0 * _CELL)
    slope_x = (np.roll(heights, -1, 1) - np.roll(heights, 1, 1)) / (2.0 * _CELL)
    facing = (_LIGHT[2] - slope_x * _LIGHT[0] - slope_y * _LIGHT[1]) / np.sqrt(1.0 + slope_x**2 + slope_y**2)
    return np.asarray(0.35 + 0.65 * np.maximum(facing, 0.0) / _LIGHT[2])


def _sand(rng: np.random.Generator) -> TextureTile:
    """Sand with ripples of all sizes, dark algae and bright pebbles."""
    size, metres = _SAND, _SAND * _GRAIN
    sand = 24.0 * _fractal(rng, size, 0.9, metres / 2.0, size / 2.5)
    algae = _fractal(rng, size, 1.4, metres / 1.2, metres / 0.05)
    pebbles = _fractal(rng, size, 0.4, metres / 0.35, metres / 0.06)
    grey = 118.0 + sand - 30.0 * _step(algae, 0.8) + 55.0 * _step(pebbles, 1.7)
    return mip_chain(grey, _GRAIN)


def _grains(rng: np.random.Generator) -> TextureTile:
    return mip_chain(128.0 + 26.0 * _fractal(rng, _FINE, 0.7, _FINE * _FINE_GRAIN / 0.3, _FINE / 2.5), _FINE_GRAIN)


def _step(noise: Floats, threshold: float) -> Floats:
    """0 below the threshold, 1 above, with a soft border."""
    share = np.clip((noise - threshold) / 0.35 + 0.5, 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))
