import itertools

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.grid_graph import grid_graph_of
from lidarena.planning.team.lifelong_window import adopt_if_cheaper, improve, path_cost, waiting_team
from tests.planning.team.problems import MOVES, meet, problems

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]
WINDOW = 5


def planned(problem, rounds, window=WINDOW):
    """A team's graph, goals, costs of what is left, and plan after some repairs."""
    graph = grid_graph_of(problem.grid, problem.connectivity, problem.radius)
    starts, goals = (graph.index[ends[:, 0], ends[:, 1]] for ends in (problem.starts, problem.goals))
    goals = goals.astype(np.int64)
    ahead = np.stack([graph.ahead(int(goal)) for goal in goals])
    plan = waiting_team(starts.astype(np.int32), len(graph), window)
    total = improve(np.int64(rounds), goals, graph.arrays, ahead, plan, np.array([7], np.uint64))
    return graph, goals, ahead, plan, total


def least_cost(problem, graph, plan, robot, ahead) -> int:
    """The cheapest path of one robot past the others' paths, by going through all of them."""
    cells = graph.cells[plan.paths]
    others = [i for i in range(len(cells)) if i != robot]
    goal = tuple(problem.goals[robot])
    states = {(tuple(cells[robot, 0]), None)}
    for t in range(WINDOW):
        following = set()
        for here, reached in states:
            for dr, dc in MOVES[: problem.connectivity + 1]:
                there = here[0] + dr, here[1] + dc
                place = graph.index[here]
                if not any(n >= 0 and tuple(graph.cells[n]) == there for n in graph.neighbours[place]):
                    continue
                if any(meet(here, cells[i, t], there, cells[i, t + 1], 2 * problem.radius) for i in others):
                    continue
                following.add((there, reached if reached or there != goal else t + 1))
        states = following
    return min(reached or WINDOW + ahead[graph.index[there]] // 4096 for there, reached in states)


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4), radii=st.sampled_from([0.0, 0.5])), st.integers(0, 40))
def test_plans_are_free_of_conflicts_and_cost_what_they_say(problem, rounds) -> None:
    graph, goals, ahead, plan, total = planned(problem, rounds)
    cells = graph.cells[plan.paths]
    assert (plan.paths[:, 0] == graph.index[problem.starts[:, 0], problem.starts[:, 1]]).all()
    for t in range(WINDOW):
        for i, j in itertools.combinations(range(len(cells)), 2):
            assert not meet(cells[i, t], cells[j, t], cells[i, t + 1], cells[j, t + 1], 2 * problem.radius)
    for robot, path in enumerate(plan.paths):
        assert (np.sort(np.flatnonzero(plan.occupant[2] == robot)) == [path[2]]).all()
        for t, move in enumerate(plan.moves[robot]):
            assert graph.neighbours[path[t], move] == path[t + 1]
        times = np.flatnonzero(path[1:] == goals[robot])
        cost = times[0] + 1 if len(times) else WINDOW + ahead[robot, path[-1]] // 4096
        assert path_cost(path, goals[robot], ahead[robot]) == cost == plan.costs[robot]
    assert total == plan.costs.sum()


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 3), sides=st.integers(2, 5), radii=st.sampled_from([0.0, 0.5])))
def test_a_robot_gets_the_cheapest_path_past_the_others(problem) -> None:
    graph, _, ahead, plan, _ = planned(problem, 0)
    last = len(problem.starts) - 1  # nobody was planned after it
    assert plan.costs[last] == least_cost(problem, graph, plan, last, ahead[last])


@settings(max_examples=15, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4), radii=st.sampled_from([0.0, 0.5])))
def test_repairs_make_nothing_dearer_and_only_cheaper_plans_are_taken_over(problem) -> None:
    graph, goals, ahead, plan, before = planned(problem, 0)
    first = np.ascontiguousarray(plan.paths.T)
    after = improve(np.int64(30), goals, graph.arrays, ahead, plan, np.array([3], np.uint64))
    assert after <= before
    assert not adopt_if_cheaper(first, goals, graph.arrays, ahead, plan, False)
    assert adopt_if_cheaper(first, goals, graph.arrays, ahead, plan, True)
    assert (plan.paths == first.T).all() and (plan.occupant[1] >= 0).sum() == len(goals)
    if after < before:
        better = planned(problem, 0)[3]
        improve(np.int64(30), goals, graph.arrays, ahead, better, np.array([3], np.uint64))
        assert adopt_if_cheaper(np.ascontiguousarray(better.paths.T), goals, graph.arrays, ahead, plan, False)


def test_two_that_meet_in_a_door_let_each_other_pass() -> None:
    grid = np.ones((3, 7), bool)
    grid[1], grid[0, 2] = False, False
    graph = grid_graph_of(grid, 4, 0.0)
    goals = graph.index[[1, 1], [6, 0]].astype(np.int64)
    ahead = np.stack([graph.ahead(int(goal)) for goal in goals])
    plan = waiting_team(graph.index[[1, 1], [0, 6]].astype(np.int32), len(graph), 10)
    assert improve(np.int64(60), goals, graph.arrays, ahead, plan, np.array([5], np.uint64)) == 9 + 6
