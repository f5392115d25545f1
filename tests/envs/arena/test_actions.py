import math

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.base.errors import ActionError
from lidarena.envs.arena.actions import HEADINGS, action_of, heading_space, turns_of


@given(st.floats(-50.0, 50.0))
def test_a_continuous_action_turns_by_what_was_wanted(turn: float) -> None:
    space = heading_space("continuous")
    action = action_of(space, turn)
    assert space.contains(action)
    assert math.remainder(turns_of("continuous", [action], 1)[0] - turn, 2 * math.pi) == pytest.approx(0, abs=1e-6)


@given(st.floats(-50.0, 50.0))
def test_a_discrete_action_is_the_nearest_heading(turn: float) -> None:
    space = heading_space("discrete")
    action = action_of(space, turn)
    assert space.contains(action)
    off = math.remainder(turns_of("discrete", np.array([action]), 1)[0] - turn, 2 * math.pi)
    assert abs(off) <= math.pi / HEADINGS + 1e-9


def test_the_spaces() -> None:
    assert heading_space("discrete") == gym.spaces.Discrete(16)
    assert heading_space("continuous") == gym.spaces.Box(-1.0, 1.0, (1,), np.float32)


def test_whole_batches_are_turned() -> None:
    assert turns_of("continuous", np.array([[0.5], [-1.0], [0.0]]), 3) == pytest.approx([math.pi / 2, -math.pi, 0.0])
    assert turns_of("discrete", np.array([0, 4, 8]), 3) == pytest.approx([0.0, math.pi / 2, math.pi])


@pytest.mark.parametrize(
    ("kind", "actions", "message"),
    [
        ("continuous", np.zeros((2, 1)), "not an array of one number"),
        ("continuous", [[np.inf]], "NaN or out of range"),
        ("continuous", [[-1.01]], "from -1 to 1"),
        ("discrete", np.array([1.0]), "not one of the whole numbers 0 to 15"),
        ("discrete", np.array([16]), "out of range; 0 to 15"),
        ("discrete", np.array([1, 2]), "whole numbers"),
    ],
)
def test_refusals_name_the_action_and_what_is_allowed(kind: str, actions: object, message: str) -> None:
    with pytest.raises(ActionError, match=message):
        turns_of(kind, actions, 1)


def test_a_long_action_is_not_printed_in_full() -> None:
    with pytest.raises(ActionError) as refusal:
        turns_of("continuous", np.zeros(500), 1)
    assert len(str(refusal.value)) < 200
