from typing import Any

import pytest

from lidarena.envs.exploration.options import ExplorationKeywords, ExplorationOptions
from tests.envs.options_cases import (
    WRONG,
    check_a_changed_robot,
    check_defaults,
    check_editors_see_every_keyword,
    check_refused,
)

OWN: list[tuple[dict[str, Any], str]] = [
    ({"map": []}, "map = "),
    ({"start": (0, 0)}, "must be a pose"),
    ({"start": "randm"}, "'random' or None"),
    ({"stop_at": 1.5}, "stop_at = 1.5"),
    ({"patience": 0.0}, "patience = 0.0"),
    ({"slam": "rbf"}, "did you mean 'rbpf'"),
    ({"eta": 0.0}, "eta = 0.0"),
]


def test_keywords_are_typed_have_their_defaults_and_change_parts_of_the_robot() -> None:
    check_editors_see_every_keyword(ExplorationOptions, ExplorationKeywords)
    check_defaults(ExplorationOptions, 1000)
    check_a_changed_robot(ExplorationOptions)


@pytest.mark.parametrize(("keywords", "says"), WRONG + OWN)
def test_what_is_out_of_range_is_refused(keywords: dict[str, Any], says: str) -> None:
    check_refused(ExplorationOptions, keywords, says)
