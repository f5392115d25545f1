"""Plan generation against closed formulas and brute force."""

import itertools
import math

import numpy as np
import pytest

from lidarena.envs.workshop.compiler.plans import enumerate_plans
from lidarena.envs.workshop.task import load_task
from tests.envs.workshop.workshops import action, chain, loose, task_of


@pytest.mark.parametrize("count", [1, 3, 5])
def test_a_chain_has_two_to_the_n_plans(count: int) -> None:
    plans = enumerate_plans(load_task(chain(count)).arrays, 10_000)
    assert plans is not None and len(plans) == 2**count


@pytest.mark.parametrize("count", [1, 2, 4, 5])
def test_loose_actions_have_n_plus_one_times_n_factorial_plans(count: int) -> None:
    plans = enumerate_plans(load_task(loose(count)).arrays, 10_000)
    assert plans is not None and len(plans) == (count + 1) * math.factorial(count)
    assert len({plan.tobytes() for plan in plans}) == len(plans)


def test_beyond_the_limit_there_is_no_list() -> None:
    assert enumerate_plans(load_task(loose(5)).arrays, 719) is None
    assert len(enumerate_plans(load_task(loose(5)).arrays, 720)) == 720  # type: ignore[arg-type]


def has_cycle(before: np.ndarray, plan: np.ndarray) -> bool:
    """Whether precedence and sequences contradict each other, by Warshall's closure."""
    reach = before.copy()
    for order in plan:
        known = order[order >= 0]
        reach[known[:-1], known[1:]] = True
    for k in range(len(reach)):
        reach |= np.outer(reach[:, k], reach[k])
    return bool(reach.diagonal().any())


def test_all_plans_are_found_and_no_other() -> None:
    """Brute force over allocations and permutations of a small graph with who can do what."""
    task = load_task(task_of({
        "w": action("a"), "x": action("b", human=None), "y": action("c", after=["w"]),
        "z": action("d", after=["w", "x"]),
    })).arrays  # fmt: skip
    expected = set()
    for owners in itertools.product((0, 1), repeat=4):
        if not all(task.capable[owner, k] for k, owner in enumerate(owners)):
            continue
        shares = [[k for k in range(4) if owners[k] == agent] for agent in (0, 1)]
        for human, robot in itertools.product(*(itertools.permutations(share) for share in shares)):
            plan = np.full((2, 4), -1, np.int64)
            plan[0, : len(human)], plan[1, : len(robot)] = human, robot
            if not has_cycle(task.before, plan):
                expected.add(plan.tobytes())
    found = enumerate_plans(task, 10_000)
    assert found is not None and {plan.tobytes() for plan in found} == expected
