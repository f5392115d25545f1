"""Decisions are read from actions, or refused."""

from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ActionError
from lidarena.envs.seabed.actions import action_of, decision_space, decisions_of

SKIPS = (2, 5, 20)


def test_actions_are_numbers_of_skips_and_modes() -> None:
    assert decision_space(SKIPS).nvec.tolist() == [3, 3]
    assert decisions_of([[0, 0], [2, 2]], 2, SKIPS) == [(2, "plain"), (20, "six_clouds_to_middle")]
    assert decisions_of([[1, 0]], 1, (0.75, 0.5)) == [(0.5, "plain")]


@pytest.mark.parametrize(("frames", "number"), [(1, 0), (2, 0), (4.9, 0), (5, 1), (19, 1), (500, 2)])
def test_the_longest_skip_that_fits_is_taken(frames: float, number: int) -> None:
    assert action_of(SKIPS, frames, "six_clouds").tolist() == [number, 1]


@pytest.mark.parametrize(
    ("actions", "words"),
    [
        ([[3, 0]], "0 to 2 for the skip"),
        ([[0, -1]], "is out of range"),
        ([[0.5, 1.0]], "is not a pair of whole numbers"),
        ([[0, 1, 2]], "is not a pair"),
        ([3], "is not a pair"),
        ([[np.nan, 0]], "is not a pair"),
        ([[1, 2], [3]], "is not a pair"),
    ],
)
def test_other_actions_are_refused(actions: Any, words: str) -> None:
    with pytest.raises(ActionError, match=words):
        decisions_of(actions, 1, SKIPS)
