import itertools

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.moves import MOVES
from lidarena.planning.team.pibt import next_configuration, random_below, team_step
from tests.planning.team.problems import Problem, meet, problems, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


def decide(problem: Problem, order: list[int], told: list[int], seed: int = 0):
    """The team's graph, whether a step was found, and the moves decided on."""
    traffic = traffic_of(problem)
    arrays = traffic.graph.arrays
    step = team_step(arrays, traffic.ends[:, 1], seed)
    step.here[:] = traffic.ends[:, 0]
    step.occupant[step.here] = np.arange(len(traffic))
    constraints = np.array(told + [0] * (len(traffic) - len(told)), np.int64)
    ordered = np.array(order, np.int16)
    made = next_configuration(ordered, constraints, np.int64(len(told)), arrays, traffic.ahead, step)
    return traffic, made, step.moves.copy()


@settings(max_examples=60, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4), radii=st.sampled_from([0.0, 0.5])), st.integers(0, 99), st.data())
def test_a_step_hits_nobody_keeps_to_the_grid_and_to_what_robots_are_told(problem, seed, data) -> None:
    traffic = traffic_of(problem)
    team = len(traffic)
    order = data.draw(st.permutations(range(team)))
    told = []
    for robot in order[: data.draw(st.integers(0, team))]:
        ways = traffic.graph.neighbours[traffic.ends[robot, 0]]
        told.append(int(data.draw(st.sampled_from(np.flatnonzero(ways >= 0).tolist()))))
    traffic, made, moves = decide(problem, order, told, seed)
    here = problem.starts
    if not made:
        assert told  # without constraints everyone can at least wait
        return
    there = here + MOVES[moves]
    assert (traffic.graph.neighbours[traffic.ends[:, 0], moves] >= 0).all()
    for i, j in itertools.combinations(range(team), 2):
        assert not meet(here[i], here[j], there[i], there[j], 2 * problem.radius)
    assert [int(moves[robot]) for robot in order[: len(told)]] == told


def test_the_first_robot_pushes_a_chain_of_others_before_it() -> None:
    row = Problem(np.zeros((1, 5), bool), np.array([(0, 0), (0, 1), (0, 2)]), np.array([(0, 4), (0, 1), (0, 2)]), 4)
    _, made, moves = decide(row, [0, 1, 2], [])
    assert made and moves.tolist() == [1, 1, 1]


def test_a_robot_at_its_goal_steps_aside_only_for_one_before_it() -> None:
    cross = np.array([[c == "@" for c in r] for r in ("@.@", "...", "@.@")])
    problem = Problem(cross, np.array([(1, 0), (1, 1)]), np.array([(1, 2), (1, 1)]), 4)
    _, _, moves = decide(problem, [0, 1], [])
    assert moves[0] == 1 and moves[1] != 0
    _, _, moves = decide(problem, [1, 0], [])
    assert moves.tolist() == [0, 0]


def test_a_disc_clears_several_others_out_of_its_way() -> None:
    starts = np.array([(1, 1), (0, 3), (2, 3)])
    problem = Problem(np.zeros((9, 13), bool), starts + 3, np.array([(4, 10), (3, 6), (5, 6)]), 8, 1.0)
    for seed in range(5):
        _, made, moves = decide(problem, [0, 1, 2], [], seed)
        assert made and MOVES[moves[0], 1] == 1
        there = problem.starts + MOVES[moves]
        assert not any(meet(problem.starts[0], problem.starts[i], there[0], there[i], 2.0) for i in (1, 2))


def test_contradicting_constraints_allow_no_step() -> None:
    row = Problem(np.zeros((1, 3), bool), np.array([(0, 0), (0, 1)]), np.array([(0, 1), (0, 0)]), 4)
    _, made, _ = decide(row, [0, 1], [1, 3])  # they would swap
    assert not made


@pytest.mark.parametrize("bound", [2, 10, 1000])
def test_random_numbers_are_below_their_bound_and_spread(bound: int) -> None:
    state = np.array([12345], np.uint64)
    numbers = [random_below.py_func(state, bound) for _ in range(2000)]
    assert min(numbers) >= 0 and max(numbers) < bound
    assert abs(np.mean(numbers) / (bound - 1) - 0.5) < 0.03
