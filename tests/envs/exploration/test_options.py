from typing import Any

from lidarena.envs.exploration.options import ExplorationKeywords, ExplorationOptions
from tests.envs.options_cases import check_all

WRONG: list[tuple[dict[str, Any], str]] = [
    ({"map": []}, "map = "),
    ({"start": (0, 0)}, "must be a pose"),
    ({"start": "randm"}, "'random' or None"),
    ({"stop_at": 1.5}, "stop_at = 1.5"),
    ({"patience": 0.0}, "patience = 0.0"),
    ({"slam": "rbf"}, "did you mean 'rbpf'"),
    ({"eta": 0.0}, "eta = 0.0"),
]


def test_exploration_keywords_keep_what_all_keywords_promise() -> None:
    check_all(ExplorationOptions, ExplorationKeywords, 1000, WRONG)
