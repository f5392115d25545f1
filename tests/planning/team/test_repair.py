"""Large-neighbourhood repair: whatever it tries, the plan is a plan, and never a worse one."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from lidarena.planning.team.budget import Budget
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.prioritized import conflicts_of
from lidarena.planning.team.repair import Repair
from lidarena.planning.team.traffic import Traffic


def crowd(seed: int, robots: int = 7, radius: float = 0.0) -> Traffic:
    """A crowded hall, everyone placed by the first order that lets everyone through."""
    rng = np.random.default_rng(seed)
    while True:
        grid = rng.random((6, 6)) < 0.12
        graph = GridGraph(grid, 8, radius)
        ends = np.stack([rng.permutation(len(graph))[:robots] for _ in range(2)], axis=1).astype(np.int64)
        traffic = Traffic(graph, ends)
        if (traffic.alone < 100).all() and traffic.plan(rng.permutation(robots)) == robots:
            return traffic
        traffic.close()


@pytest.mark.parametrize("seed", range(6))
def test_no_neighbourhood_makes_a_plan_worse(seed: int) -> None:
    traffic, rng = crowd(seed), np.random.default_rng(seed)
    ends, cost = traffic.ends.copy(), traffic.cost()
    for _ in range(40):
        assert Repair(traffic, rng).run(Budget(math.inf, 1), 10) <= 1
        assert traffic.alone.sum() <= traffic.cost() <= cost
        cost = traffic.cost()
        assert (conflicts_of(traffic) < 0).all()
        reached = traffic.paths[np.arange(len(traffic)), traffic.lengths]
        assert np.array_equal(np.stack([traffic.paths[:, 0], reached], axis=1), ends)
        assert traffic.placed.all() and not traffic.delays.any()


def test_repair_saves_what_a_bad_order_costs() -> None:
    saved = 0
    for seed in range(6):
        traffic = crowd(seed)
        before = traffic.cost()
        Repair(traffic, np.random.default_rng(0)).run(Budget(math.inf, 200), 60)
        saved += before - traffic.cost()
    assert saved > 0


def test_nothing_is_tried_where_nothing_can_be_gained() -> None:
    graph = GridGraph(np.zeros((4, 9), bool), 8, 0.0)
    traffic = Traffic(graph, np.array([[0, 8], [27, 35]], np.int64))
    assert traffic.plan(np.array([0, 1])) == 2
    assert Repair(traffic, np.random.default_rng(0)).run(Budget(math.inf), 50) == 0


def test_patience_and_budget_end_a_repair_that_gains_nothing() -> None:
    corridor = np.ones((2, 7), bool)
    corridor[1], corridor[0, 2] = False, False
    graph = GridGraph(corridor, 4, 0.0)
    traffic = Traffic(graph, graph.index[1, [(0, 6), (6, 0)]].astype(np.int64))
    assert traffic.plan(np.array([1, 0])) == 2  # the first one dodges into the niche, which is near to it
    Repair(traffic, np.random.default_rng(1)).run(Budget(math.inf), 30)
    assert traffic.cost() >= traffic.alone.sum() + 2  # aside and back
    assert Repair(traffic, np.random.default_rng(2)).run(Budget(math.inf), 5) >= 5
    assert Repair(traffic, np.random.default_rng(3)).run(Budget(math.inf, 3), 50) == 3


@pytest.mark.parametrize(("team", "share"), [(40, 0.9), (20, 0.5)])
def test_in_a_crowd_it_begins_more_often_with_who_is_very_late(team: int, share: float) -> None:
    alone = np.full(team, 10)
    delays = np.zeros(team, np.int64)
    delays[3], delays[7] = 9, 1

    class Team(SimpleNamespace):
        def __len__(self) -> int:
            return team

    repair = Repair(Team(lengths=alone + delays, alone=alone), np.random.default_rng(0))  # type: ignore[arg-type]
    begun = np.array([repair._late_robot() for _ in range(2000)])
    assert set(begun.tolist()) == {3, 7}
    assert (begun == 3).mean() == pytest.approx(share, abs=0.05)
