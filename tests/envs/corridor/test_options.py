from typing import Any

from lidarena.envs.corridor.options import CorridorKeywords, CorridorOptions
from tests.envs.options_cases import check_all

WRONG: list[tuple[dict[str, Any], str]] = [
    ({"robots": 65}, "robots = 65"),
    ({"places": "random", "starts": [(1, 1)], "goals": [(2, 2)]}, "in place of places"),
    ({"starts": [(1, 1)]}, "given together"),
    ({"places": "randon"}, "did you mean 'random'"),
    ({"map": 3}, "map = 3"),
    ({"collision_ends": 1}, "must be true or false"),
    ({"robot": {"radius": 3.0}}, "robot.radius = 3.0"),
]


def test_corridor_keywords_keep_what_all_keywords_promise() -> None:
    check_all(CorridorOptions, CorridorKeywords, 1000, WRONG)
