from typing import Any

import pytest

from lidarena.envs.corridor.options import CorridorKeywords, CorridorOptions
from tests.envs.options_cases import (
    WRONG,
    check_a_changed_robot,
    check_defaults,
    check_editors_see_every_keyword,
    check_refused,
)

OWN: list[tuple[dict[str, Any], str]] = [
    ({"robots": 65}, "robots = 65"),
    ({"places": "random", "starts": [(1, 1)], "goals": [(2, 2)]}, "in place of places"),
    ({"starts": [(1, 1)]}, "given together"),
    ({"places": "randon"}, "did you mean 'random'"),
    ({"map": 3}, "map = 3"),
    ({"collision_ends": 1}, "must be true or false"),
    ({"robot": {"radius": 3.0}}, "robot.radius = 3.0"),
]


def test_keywords_are_typed_have_their_defaults_and_change_parts_of_the_robot() -> None:
    check_editors_see_every_keyword(CorridorOptions, CorridorKeywords)
    check_defaults(CorridorOptions, 1000)
    check_a_changed_robot(CorridorOptions)


@pytest.mark.parametrize(("keywords", "says"), WRONG + OWN)
def test_what_is_out_of_range_is_refused(keywords: dict[str, Any], says: str) -> None:
    check_refused(CorridorOptions, keywords, says)
