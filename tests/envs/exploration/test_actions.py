import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import ActionError
from lidarena.envs.exploration.actions import action_space, commands_of, discrete_commands
from lidarena.world.robots import RobotSpec

COMMANDS = discrete_commands(RobotSpec())
PART = st.floats(-1.0, 1.0)


@pytest.mark.parametrize("kind", ["discrete", "continuous"])
@pytest.mark.parametrize("worlds", [1, 5])
def test_every_action_of_the_space_is_a_command_that_the_robot_can_do(kind: str, worlds: int) -> None:
    space, spec = action_space(kind), RobotSpec()
    space.seed(0)
    for _ in range(20):
        commands = commands_of(kind, np.array([space.sample() for _ in range(worlds)]), worlds)
        assert commands.shape == (worlds, 2) and commands.dtype == np.float64
        assert (commands[:, 0] >= 0).all() and (commands[:, 0] <= spec.max_speed).all()
        assert (np.abs(commands[:, 1]) <= spec.max_turn_rate).all()


def test_the_three_actions_are_forward_left_and_right() -> None:
    forward, left, right = commands_of("discrete", np.array([0, 1, 2]), 3)
    assert forward.tolist() == [0.5, 0.0] and left[1] > 0 > right[1]
    assert left[0] == right[0] and left[1] == -right[1]


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(PART, PART), min_size=1, max_size=6))
def test_continuous_actions_are_scaled_linearly(actions: list[tuple[float, float]]) -> None:
    commands = commands_of("continuous", np.array(actions), len(actions))
    for (speed, rate), (v, w) in zip(actions, commands, strict=True):
        assert v == pytest.approx(0.5 * (speed + 1) / 2) and w == pytest.approx(rate)


def test_the_ends_of_the_range_stand_still_and_go_full_speed() -> None:
    commands = commands_of("continuous", np.array([(-1.0, -1.0), (1.0, 1.0)]), 2)
    assert commands.tolist() == [[0.0, -1.0], [0.5, 1.0]]


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(-2, 4), min_size=1, max_size=4), st.sampled_from([np.int8, np.int64, np.uint8]))
def test_whole_numbers_are_actions_or_refused(numbers: list[int], kind: type) -> None:
    actions = np.array(numbers, np.int64).astype(kind)
    if all(0 <= number < len(COMMANDS) for number in numbers):
        np.testing.assert_array_equal(commands_of("discrete", actions, len(numbers)), COMMANDS[numbers])
    else:
        with pytest.raises(ActionError, match=r"out of range; 0 \(forward\), 1 \(left\), 2 \(right\)"):
            commands_of("discrete", actions, len(numbers))


@pytest.mark.parametrize(
    ("kind", "actions", "worlds", "says"),
    [
        ("discrete", 1, 1, "not one of the whole numbers"),
        ("discrete", [0, 1], 3, "not one of the whole numbers"),
        ("discrete", [[0]], 1, "not one of the whole numbers"),
        ("discrete", [1.0], 1, "convert it to an integer"),
        ("discrete", [0.5], 1, "0 to 2$"),
        ("discrete", [True], 1, "not one of the whole numbers"),
        ("discrete", ["0"], 1, "'0'"),
        ("discrete", [None], 1, "None"),
        ("continuous", [0.0, 0.0], 1, "not a pair of numbers"),
        ("continuous", [[0.0, 0.0, 0.0]], 1, "not a pair of numbers"),
        ("continuous", [[0.0, np.nan]], 1, "NaN or out of range"),
        ("continuous", [[0.0, np.inf]], 1, "NaN or out of range"),
        ("continuous", [[1.00001, 0.0]], 1, "NaN or out of range"),
        ("continuous", [["a", "b"]], 1, "not a pair of numbers"),
        ("continuous", np.zeros((40, 3)), 40, r"\.\.\. is not a pair"),
    ],
)
def test_what_is_no_action_is_refused_in_one_sentence(kind: str, actions: object, worlds: int, says: str) -> None:
    with pytest.raises(ActionError, match=says) as caught:
        commands_of(kind, actions, worlds)
    assert "\n" not in str(caught.value)


def test_commands_are_fresh_arrays() -> None:
    commands = commands_of("discrete", np.array([0, 0]), 2)
    commands[:] = 9.0
    assert commands_of("discrete", np.array([0]), 1).tolist() == [[0.5, 0.0]]
