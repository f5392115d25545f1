"""What water may be."""

import pytest

from lidarena.base.errors import ConfigError
from lidarena.vision.water import CLEAR, Water


def test_clear_water_does_nothing() -> None:
    assert (CLEAR.haze, CLEAR.backscatter, CLEAR.vignetting, CLEAR.noise) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("change", [{"haze": -1.0}, {"vignetting": 1.0}, {"noise": 80.0}, {"backscatter": 300.0}])
def test_water_that_cannot_be_is_refused(change: dict[str, float]) -> None:
    with pytest.raises(ConfigError, match=next(iter(change))):
        Water(**change)
