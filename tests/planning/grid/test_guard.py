"""Robots that can neither stop nor reverse, in narrow places, with plans that are taken from them at any moment."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from lidarena.planning.grid.guard import carried, circle_distance, is_safe, nearby, turn_in_place, way_out
from lidarena.planning.grid.path_following import predict
from lidarena.planning.grid.steering import Commands

DISCRETE = Commands.of([(0.5, 0.0), (0.05, 0.3), (0.05, -0.3)], 0.2)
CONTINUOUS = Commands.of([(0.5, 0.0), (0.0, 1.0), (0.0, -1.0), (0.5, 0.5), (0.5, -0.5)], 0.2)
KEEP, TOUCH = 0.135, 0.12
POSE = st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.floats(-7.0, 7.0))


def wall(x0: float, y0: float, x1: float, y1: float) -> NDArray[np.float64]:
    n = math.ceil(math.hypot(x1 - x0, y1 - y0) / 0.01) + 1
    return np.stack([np.linspace(x0, x1, n), np.linspace(y0, y1, n)], axis=1)


def seen(walls: NDArray[np.float64], pose: NDArray[np.float64]) -> NDArray[np.float64]:
    """All of the walls that is near, in the robot's frame."""
    points: NDArray[np.float64] = nearby(walls, pose)
    return points


def clearance(walls: NDArray[np.float64], pose: NDArray[np.float64]) -> float:
    return float(np.hypot(*(walls - pose[:2]).T).min())


@settings(deadline=None)
@given(POSE, POSE, st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=1, max_size=5))
def test_what_is_carried_along_lies_before_the_robot_as_it_did(
    before: tuple[float, ...], after: tuple[float, ...], own: list[tuple[float, float]]
) -> None:
    points, zero = np.array(own), np.zeros(3)
    there = carried(points, zero, np.array(before))
    assert carried(there, np.array(before), zero) == pytest.approx(points, abs=1e-9)
    moved = carried(there, np.array(before), np.array(after))
    assert moved == pytest.approx(carried(points, zero, np.array(after)), abs=1e-9)
    turn = complex(math.cos(after[2]), math.sin(after[2]))
    expected = [complex(*after[:2]) + turn * complex(*point) for point in own]
    assert moved == pytest.approx(np.array([(z.real, z.imag) for z in expected]), abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(st.floats(-0.9, 0.9), st.floats(-0.9, 0.9)), min_size=1, max_size=4),
    st.lists(st.integers(0, 2), min_size=1, max_size=9),
)
def test_a_safe_sequence_touches_nothing_that_was_not_touched_before(
    own: list[tuple[float, float]], sequence: list[int]
) -> None:
    points, todo = np.array(own), np.array(sequence)
    assume((np.hypot(*points.T) > TOUCH).all())
    safe = is_safe(points, DISCRETE, todo, KEEP)
    fine = Commands.of(DISCRETE.velocities, 0.01)  # twenty pieces of every command
    poses = predict(np.zeros(3), fine, np.repeat(todo, 20))
    apart = np.hypot(poses[:, None, 0] - points[:, 0], poses[:, None, 1] - points[:, 1]).min(axis=0)
    before = np.hypot(*points.T)
    if safe:
        assert (apart >= np.minimum(KEEP - 0.005, before - 0.003)).all()
    elif (apart >= before - 1e-3).all() or (apart > KEEP + 0.005).all():  # then it is for want of room at the end
        turns = [circle_distance(points, poses[-1], v) for v in DISCRETE.velocities[1:]]
        assert max(turns) < KEEP


def test_it_turns_to_the_left_unless_a_wall_is_there_and_goes_on_as_it_began() -> None:
    left, right = 1, 2
    beside = wall(-1.0, 0.4, 1.0, 0.4)
    assert turn_in_place(np.empty((0, 2)), DISCRETE, -1, KEEP, 0.2) == left
    assert turn_in_place(beside, DISCRETE, -1, KEEP, 0.2) == right
    assert turn_in_place(beside * (1.0, -1.0), DISCRETE, -1, KEEP, 0.2) == left
    assert turn_in_place(beside, CONTINUOUS, -1, KEEP, 0.2) == 1  # on the spot there is room
    far = wall(-1.0, 0.52, 1.0, 0.52)
    assert (
        turn_in_place(far, DISCRETE, -1, KEEP, 0.2) == right and turn_in_place(far, DISCRETE, left, KEEP, 0.2) == left
    )
    passage = np.concatenate([wall(-2, 0.25, 2, 0.25), wall(-2, -0.25, 2, -0.25)])
    assert turn_in_place(passage, DISCRETE, left, KEEP, 0.2) == -1


BENT = np.concatenate([
    wall(0.0, 0.0, 3.0, 0.0), wall(0.0, 1.2, 1.2, 1.2), wall(0.0, 0.0, 0.0, 1.2), wall(1.2, 1.2, 1.2, 0.5),
    wall(1.2, 0.5, 2.5, 0.5), wall(3.0, 0.0, 3.0, 2.5), wall(2.5, 0.5, 2.5, 1.2), wall(2.5, 1.2, 1.5, 1.2),
    wall(1.5, 1.2, 1.5, 2.5), wall(1.5, 2.5, 3.0, 2.5),
])  # fmt: skip
"""Two rooms, and between them a passage half a metre wide with a corner."""


@pytest.mark.parametrize(
    "start", [(1.3, 0.25, 0.0), (1.9, 0.24, 0.1), (2.3, 0.25, 0.0), (2.75, 0.7, 1.5), (1.9, 0.26, 3.1)]
)
def test_there_is_a_way_out_of_a_passage_to_where_the_robot_can_turn(start: tuple[float, float, float]) -> None:
    pose = np.array(start)
    points = seen(BENT, pose)
    assert turn_in_place(points, DISCRETE, -1, KEEP, 0.2) == -1
    for _ in range(4):
        sequence = way_out(points, DISCRETE, KEEP)
        assert len(sequence)
        poses = predict(pose, DISCRETE, sequence)
        assert min(clearance(BENT, at) for at in poses) > KEEP - 0.015
        pose = poses[-1]
        points = seen(BENT, pose)
        if turn_in_place(points, DISCRETE, -1, KEEP, 0.2) >= 0:
            return
    pytest.fail("it is still in the passage")


def test_there_is_no_way_out_of_a_box_that_is_too_small() -> None:
    box = np.concatenate([wall(-0.2, y, 0.2, y) for y in (-0.2, 0.2)] + [wall(x, -0.2, x, 0.2) for x in (-0.2, 0.2)])
    assert len(way_out(box, DISCRETE, KEEP)) == 0


@pytest.mark.parametrize("seed", range(6))
def test_whose_plans_are_taken_away_at_any_moment_touches_nothing(seed: int) -> None:
    """Plans are random commands, taken as long as they are safe, and forgotten at random."""
    rng = np.random.default_rng(seed)
    pose, queue, turning, visited = np.array([0.6, 0.6, rng.uniform(-3, 3)]), np.empty(0, np.int64), -1, []
    for _ in range(500):
        points = seen(BENT, pose) + rng.normal(0.0, 0.003)
        if len(queue) == 0 or rng.random() < 0.1:
            wanted = np.repeat(rng.integers(0, 3, 4), rng.integers(1, 20, 4))
            queue = wanted if is_safe(points, DISCRETE, wanted, KEEP) else np.empty(0, np.int64)
        if len(queue) and not is_safe(points, DISCRETE, queue, KEEP):
            queue = np.empty(0, np.int64)
        if len(queue) == 0:
            turning = turn_in_place(points, DISCRETE, turning, KEEP, 0.2)
            queue = np.array([turning]) if turning >= 0 else way_out(points, DISCRETE, KEEP)
            assert len(queue)
        pose, queue = predict(pose, DISCRETE, queue[:1])[0], queue[1:]
        assert clearance(BENT, pose) > TOUCH
        visited.append(pose[:2])
    assert np.ptp(np.array(visited), axis=0).max() > 0.3
