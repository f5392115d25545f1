import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import ConfigError
from lidarena.planning.grid.path_following import predict
from lidarena.planning.grid.steering import Commands, loiter_gap, steer, tightest
from tests.planning.grid.test_surroundings import room

RES = 0.05
DISCRETE = Commands.of([(0.5, 0.0), (0.05, 0.3), (0.05, -0.3)], 0.2)
ON_THE_SPOT = Commands.of([(0.5, 0.0), (0.0, 1.0), (0.0, -1.0)], 0.2)


def least(around, pose, commands, sequence):
    return tightest(around.gap, around.closed, around.frame, np.array(pose, float), commands.moves, sequence)


def test_commands_are_exact_arcs():
    np.testing.assert_allclose(DISCRETE.moves[0], [0.1, 0.0, 0.0])
    radius = 0.05 / 0.3
    np.testing.assert_allclose(DISCRETE.moves[1], [radius * math.sin(0.06), radius * (1 - math.cos(0.06)), 0.06])
    np.testing.assert_allclose(DISCRETE.moves[2], DISCRETE.moves[1] * [1, -1, -1])
    np.testing.assert_allclose(ON_THE_SPOT.moves[1], [0.0, 0.0, 0.2], atol=1e-15)
    assert DISCRETE.repeats.tolist() == [1, 3, 3] and ON_THE_SPOT.repeats.tolist() == [1, 1, 1]
    circle = predict(np.zeros(3), Commands.of([(0.5, 0.0), (1.0, math.pi)], 0.1), np.full(20, 1))
    np.testing.assert_allclose(circle[-1], [0.0, 0.0, 2 * math.pi], atol=1e-12)


@pytest.mark.parametrize(
    ("velocities", "period"),
    [
        ([(0.5, 0.0), (0.0, 1.0)], 0.0),
        ([(0.5, 0.0), (0.0, math.nan)], 0.2),
        ([(-0.5, 0.0), (0.0, 1.0)], 0.2),
        ([(0.5, 0.0)], 0.2),
        ([(0.0, 1.0)], 0.2),
    ],
)
def test_useless_commands_are_refused(velocities, period):
    with pytest.raises(ConfigError, match=r"allowed|at least one"):
        Commands.of(velocities, period)


def test_loitering_room_is_that_of_the_circle():
    around = room(3.0, 3.0)
    left, right = DISCRETE.velocities[1], DISCRETE.velocities[2]
    pose = np.array([1.5, 0.5, 0.0])  # 0.5 m above the lower wall, driving along it
    assert loiter_gap(around.gap, around.closed, around.frame, pose, left) == pytest.approx(0.5, abs=0.04)
    assert loiter_gap(around.gap, around.closed, around.frame, pose, right) == pytest.approx(0.5 - 1 / 3, abs=0.04)
    spot = loiter_gap(around.gap, around.closed, around.frame, pose, ON_THE_SPOT.velocities[1])
    assert spot == pytest.approx(0.5, abs=0.03)


@settings(max_examples=60, deadline=None)
@given(
    st.tuples(st.floats(0.5, 3.5), st.floats(0.5, 2.5), st.floats(-math.pi, math.pi)),
    st.tuples(st.floats(0.5, 3.5), st.floats(0.5, 2.5)),
    st.sampled_from([DISCRETE, ON_THE_SPOT]),
)
def test_gets_there_safely_from_anywhere_in_a_room(pose, target, commands):
    around = room(4.0, 3.0, [(1.9, 1.4, 2.1, 1.6)])
    if min(math.hypot(p[0] - 2.0, p[1] - 1.5) for p in (pose, target)) < 0.6:
        return
    sequence = steer(around, np.array(pose), target, commands, reach=0.2, window=4.0, most_states=40_000)
    assert len(sequence)
    end = predict(np.array(pose), commands, sequence)[-1]
    assert math.dist(end[:2], target) <= 0.2
    assert least(around, pose, commands, sequence) >= 0.17 - 1e-9
    rooms = [loiter_gap(around.gap, around.closed, around.frame, end, v) for v in commands.velocities if v[1] != 0.0]
    assert max(rooms) >= 0.17 - 1e-9


def test_drives_straight_where_it_can():
    sequence = steer(room(4.0, 3.0), np.array([0.8, 1.5, 0.0]), (2.5, 1.5), DISCRETE)
    assert set(sequence.tolist()) == {0}


def test_a_straight_way_costs_no_turning_even_if_another_is_shorter():
    """Turning by 180° takes 10 s, in which the robot could drive 5 m; a target behind is still worth only one turn."""
    sequence = steer(room(4.0, 3.0), np.array([2.5, 1.5, 0.0]), (1.2, 1.5), DISCRETE)
    turns = sequence[sequence != 0]
    assert len(set(turns.tolist())) <= 2
    assert 0.06 * len(turns) < 4.5


def test_turns_round_in_a_corridor_of_0_8_m():
    around = room(6.0, 0.8)
    pose = (3.0, 0.4, 0.0)
    sequence = steer(around, np.array(pose), (1.6, 0.4), DISCRETE)
    assert len(sequence)
    assert least(around, pose, DISCRETE, sequence) >= 0.17 - 1e-9


def test_does_not_drive_up_to_a_wall_that_it_could_not_turn_away_from():
    around = room(3.0, 3.0)
    assert not len(steer(around, np.array([1.5, 1.5, 0.0]), (2.9, 1.5), DISCRETE, reach=0.05))
    assert not len(steer(around, np.array([1.5, 1.5, 0.0]), (3.5, 1.5), DISCRETE))


def test_gets_away_from_a_wall_it_stands_too_near_to():
    around = room(3.0, 3.0)
    pose = (1.0, 0.13, 0.1)
    sequence = steer(around, np.array(pose), (2.2, 0.8), DISCRETE)
    assert len(sequence)
    assert least(around, pose, DISCRETE, sequence) >= 0.13 - 0.03


def test_gives_up_after_as_many_states_as_allowed():
    around = room(4.0, 3.0)
    assert not len(steer(around, np.array([3.5, 1.5, 0.0]), (0.5, 1.5), DISCRETE, window=4.0, most_states=20))


def test_nothing_is_asked_of_no_commands():
    assert math.isinf(least(room(1.0, 1.0), (0.5, 0.5, 0.0), DISCRETE, np.empty(0, np.int64)))
