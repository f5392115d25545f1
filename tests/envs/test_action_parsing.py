import numpy as np
import pytest

from lidarena.base.errors import ActionError
from lidarena.envs.action_parsing import choices_of, shares_of


def test_whole_numbers_of_any_kind_are_taken() -> None:
    for actions in ([0, 2], (1, 0), np.array([2, 1], np.int8), np.array([2, 1], np.uint64)):
        assert choices_of(actions, 2, 3).tolist() == list(map(int, actions))


@pytest.mark.parametrize(
    ("actions", "says"),
    [
        ([1.0, 2.0], "0 to 2; convert it to an integer"),
        ([0.5, 1.0], r"is not one of the whole numbers 0 to 2$"),
        ([0], "is not one"),
        ([True, False], "is not one"),
        ([0, 3], r"is out of range; 0 \(left\), 1 \(right\), 2 \(back\) are allowed"),
        ([-1, 0], "is out of range"),
        ([[0], [1, 2]], "is not one"),
        (None, "action None is not one"),
    ],
)
def test_other_choices_are_refused(actions: object, says: str) -> None:
    with pytest.raises(ActionError, match=says) as refusal:
        choices_of(actions, 2, 3, ("left", "right", "back"))
    assert "\n" not in str(refusal.value)


def test_numbers_within_the_bounds_are_taken_with_what_float32_rounds() -> None:
    found = shares_of([(1.0 + 1e-7, -0.5), (-1, 0)], 2, ("speed", "turn rate"))
    assert found.tolist() == [[1.0, -0.5], [-1.0, 0.0]]


@pytest.mark.parametrize(
    ("actions", "says"),
    [
        ([(0.0, 1.01)], "action .* is NaN or out of range; numbers from -1 to 1 are allowed"),
        ([(np.nan, 0.0)], "NaN or out of range"),
        ([(0.0,)], "is not a pair of numbers, speed and turn rate, from -1 to 1"),
        ([("a", "b")], "is not a pair of numbers"),
        (np.zeros((90, 2)), "is not a pair"),
    ],
)
def test_other_numbers_are_refused(actions: object, says: str) -> None:
    with pytest.raises(ActionError, match=says) as refusal:
        shares_of(actions, 1, ("speed", "turn rate"))
    assert "\n" not in str(refusal.value) and len(str(refusal.value)) < 220


def test_a_single_number_is_called_one() -> None:
    with pytest.raises(ActionError, match="is not an array of one number, the turn over pi, from -1 to 1"):
        shares_of([0.5], 1, ("the turn over pi",))
    with pytest.raises(ActionError, match="a number from -1 to 1 is allowed"):
        shares_of([[2.0]], 1, ("the turn over pi",))
