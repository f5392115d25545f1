"""Heights and textures repeat, their levels are means, and nothing jumps between levels."""

import numpy as np
import pytest

from lidarena.base.jit import kernel
from lidarena.vision.texture import HeightGrid, TextureTile, blended_texture, height_at, mip_chain, surface

TILE = mip_chain(np.random.default_rng(0).uniform(0, 255, (64, 64)), 0.01)


@kernel
def grey_at(tile: TextureTile, x: float, y: float, lod: float) -> float:
    return blended_texture(tile, x, y, lod)


@kernel
def slopes_at(grid: HeightGrid, x: float, y: float) -> tuple[float, float, float, float]:
    return surface(grid, x, y)


def test_a_texel_shows_its_grey_in_its_middle() -> None:
    texels = TILE.texels[: 64 * 64].reshape(64, 64)
    for row, column in ((0, 0), (5, 60), (63, 63)):
        assert np.isclose(grey_at(TILE, (column + 0.5) * 0.01, (row + 0.5) * 0.01, 0.0), texels[row, column], atol=1e-3)


def test_the_texture_repeats_on_every_level() -> None:
    for lod in (0.0, 0.4, 2.0, 5.0):
        assert np.isclose(grey_at(TILE, 0.123, 0.456, lod), grey_at(TILE, 0.123 - 0.64, 0.456 + 1.28, lod), atol=0.01)


def test_every_level_has_the_same_mean_and_less_contrast() -> None:
    places = np.random.default_rng(1).uniform(0, 0.64, (500, 2))
    greys = [np.array([grey_at(TILE, x, y, lod) for x, y in places]) for lod in (0.0, 1.0, 3.0)]
    assert all(abs(one.mean() - 127) < 8 for one in greys)
    assert greys[0].std() > 1.5 * greys[1].std() > 3.0 * greys[2].std()


def test_nothing_jumps_between_two_levels() -> None:
    lods = np.linspace(0.0, 3.5, 400)
    greys = np.array([grey_at(TILE, 0.2, 0.3, lod) for lod in lods])
    assert np.abs(np.diff(greys)).max() < 2.0 and np.ptp(greys) > 1.0


def test_slopes_are_those_of_the_heights() -> None:
    relief = np.random.default_rng(2).normal(size=(32, 32, 2)).astype(np.float32)
    grid = HeightGrid(relief, 4.0)
    height, slope_x, slope_y, _ = slopes_at(grid, 1.1, 2.3)
    assert height == pytest.approx(height_at(grid, 1.1, 2.3)) and height == pytest.approx(height_at(grid, 9.1, -5.7))
    step = 1e-5
    assert slope_x == pytest.approx((height_at(grid, 1.1 + step, 2.3) - height) / step, abs=1e-3)
    assert slope_y == pytest.approx((height_at(grid, 1.1, 2.3 + step) - height) / step, abs=1e-3)
    assert height_at(grid, 0.5, 0.25) == pytest.approx(relief[1, 2, 0])
