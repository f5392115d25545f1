"""Actions of a team's robots: what they command, which one is nearest to a command, and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.base.errors import ActionError
from lidarena.envs.corridor.actions import NAMES, action_for, action_space, commands_of, discrete_commands

SPEEDS, RATES = st.floats(-1.5, 1.5), st.floats(-6.0, 6.0)


@given(SPEEDS, RATES)
def test_a_command_that_is_too_fast_becomes_slower_on_the_same_arc(speed: float, rate: float) -> None:
    action = action_for("continuous", speed, rate)
    assert action_space("continuous").contains(action)
    v, w = commands_of("continuous", [action], 1)[0]
    assert v * rate == pytest.approx(w * speed, abs=1e-5)  # the same curvature
    if abs(speed) <= 0.5 and abs(rate) <= 2.0:
        assert (v, w) == pytest.approx((speed, rate), abs=1e-6)
    else:
        assert max(abs(v) / 0.5, abs(w) / 2.0) == pytest.approx(1.0, abs=1e-6)


@given(SPEEDS, RATES)
def test_no_other_discrete_action_is_nearer_to_a_command(speed: float, rate: float) -> None:
    chosen = action_for("discrete", speed, rate)
    away = [math.hypot((v - speed) / 0.5, (w - rate) / 2.0) for v, w in discrete_commands().tolist()]
    assert away[chosen] == min(away)


def test_discrete_actions_do_what_their_names_say() -> None:
    found = dict(zip(NAMES, commands_of("discrete", np.arange(7), 7).tolist(), strict=True))
    assert found["stop"] == [0.0, 0.0] and found["forward"] == [0.5, 0.0]
    assert found["left"][0] > 0 < found["left"][1] and found["right"] == [found["left"][0], -found["left"][1]]
    assert found["turn left"][0] == 0 < found["turn left"][1] and found["turn right"][1] == -found["turn left"][1]
    assert found["back"][0] < 0 == found["back"][1]


@pytest.mark.parametrize(
    ("kind", "actions", "sentence"),
    [
        ("continuous", [(0.0, 1.01), (0, 0)], "out of range; numbers from -1 to 1"),
        ("continuous", [(0.0, math.nan), (0, 0)], "NaN or out of range"),
        ("continuous", [(0.0, math.inf), (0, 0)], "NaN or out of range"),
        ("continuous", [(0.0, 1.0)], "not a pair of numbers"),
        ("continuous", [(0.0, 1.0), (0.0,)], "not a pair of numbers"),
        ("continuous", [("a", "b"), ("c", "d")], "not a pair of numbers"),
        ("continuous", None, "not a pair of numbers"),
        ("discrete", [0, 7], "out of range; 0 .stop., 1 .forward.,.* 6 .back. are allowed"),
        ("discrete", [-1, 0], "out of range"),
        ("discrete", [0.0, 1.0], "whole numbers 0 to 6"),
        ("discrete", [True, False], "whole numbers 0 to 6"),
        ("discrete", [[0], [1]], "whole numbers 0 to 6"),
    ],
)
def test_actions_that_make_no_sense_are_refused_in_one_sentence(kind: str, actions: object, sentence: str) -> None:
    with pytest.raises(ActionError, match=sentence) as refusal:
        commands_of(kind, actions, 2)
    assert "\n" not in str(refusal.value) and len(str(refusal.value)) < 260
