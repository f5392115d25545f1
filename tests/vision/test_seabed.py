"""A seabed is its seed's, as high as was asked for, and smooth enough to be seen from above."""

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.vision.seabed import make_seabed
from tests.vision.scenes import AREA, seabed


def heights(step: float = 0.125) -> np.ndarray:
    xs, ys = np.arange(AREA[0], AREA[2] + 1e-9, step), np.arange(AREA[1], AREA[3] + 1e-9, step)
    return np.array([[seabed().height(x, y) for x in xs] for y in ys])


def test_the_relief_of_the_area_is_as_asked_for() -> None:
    found = heights()
    assert found.max() == pytest.approx(0.0, abs=1e-5) and found.min() == pytest.approx(-3.5, abs=1e-4)


def test_a_seed_is_a_seabed() -> None:
    again = make_seabed(np.random.default_rng(1), 3.5, AREA)
    other = make_seabed(np.random.default_rng(2), 3.5, AREA)
    assert np.array_equal(again.relief, seabed().relief) and np.array_equal(again.sand.texels, seabed().sand.texels)
    assert not np.array_equal(other.relief, seabed().relief) and not np.array_equal(other.sand[0], seabed().sand[0])


def test_rays_from_above_meet_the_ground_once() -> None:
    """The camera's steepest ray is 35 degrees and some roll away from the vertical."""
    found = heights()
    slopes = np.abs(np.diff(found, axis=1)) / 0.125
    assert np.quantile(slopes, 0.999) < 1.2


def test_a_seabed_can_be_level() -> None:
    flat = make_seabed(np.random.default_rng(0), 0.0, AREA)
    assert flat.height(3.0, 4.0) == 0.0


def test_an_absurd_relief_is_refused() -> None:
    with pytest.raises(ConfigError, match="relief = 80"):
        make_seabed(np.random.default_rng(0), 80.0, AREA)
