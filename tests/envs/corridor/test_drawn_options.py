"""Plans that cannot be drawn are refused where they are asked for."""

from typing import Any

import pytest

from lidarena.base.errors import ConfigError, MapError
from lidarena.envs.corridor.drawn_options import DrawnOptions


@pytest.mark.parametrize(
    ("keywords", "error", "words"),
    [
        ({"plans": []}, ConfigError, r"plans = \[\] must be a floor plan"),
        ({"plans": "office", "map": "office"}, ConfigError, "map and plans are both given"),
        ({"plans": ["office", "random:mazes"]}, MapError, "did you mean"),
        ({"plans": "office", "episodes_per_plan": 0}, ConfigError, "episodes_per_plan = 0"),
        ({"plan": "office"}, ConfigError, "did you mean 'plans'"),
    ],
)
def test_plans_that_there_are_not_are_refused(keywords: dict[str, Any], error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        DrawnOptions.checked(keywords)
