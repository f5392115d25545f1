import pytest

from lidarena.envs.workshop.compiler.compiled import beginning, plan_problem
from lidarena.envs.workshop.compiler.motion import acquire_motion
from lidarena.envs.workshop.compiler.networks import (
    CATEGORIES,
    CONSISTENT,
    CONTROLLABLE,
    INCONSISTENT,
    categorize,
    plan_network,
)
from lidarena.envs.workshop.compiler.schedule import predict
from lidarena.envs.workshop.task import load_task
from lidarena.temporal import STNU
from tests.envs.workshop.compiler.test_schedule import plan_of
from tests.envs.workshop.workshops import action, task_of


def network(deadline: float, constraints: object = (), human: object = (4, 10)) -> STNU:
    """Of a plan in which the human does x, then the robot y, without ways."""
    spec = task_of(
        {"x": action("a", human=human), "y": action("d", robot=(3, 5), after=["x"])},
        deadline=deadline, constraints=list(constraints),
    )  # fmt: skip
    task = load_task(spec)
    motion = acquire_motion(task, 0.4, space=False)
    plan = plan_of(2, [0], [1])
    return plan_network(task, plan, predict(plan_problem(task, motion), beginning(task, motion), plan))


@pytest.mark.parametrize(
    ("deadline", "category"),
    [(13.0, CONTROLLABLE), (12.9, CONSISTENT), (7.0, CONSISTENT), (6.9, INCONSISTENT)],
)
def test_a_deadline_decides_the_category(deadline: float, category: int) -> None:
    """At worst the human takes 10 s and the robot its least 3; at best the human takes 4."""
    assert categorize(network(deadline)) == category and len(CATEGORIES) == 3


def test_human_actions_are_contingent_and_robot_actions_are_not() -> None:
    made = network(50.0)
    assert {link.contingent for link in made.contingent_links} == {"x.ready", "x.end"}
    assert made.bounds("y.place", "y.end") == (3.0, 5.0) and made.bounds("now", "finish")[1] == 50.0


def test_constraints_of_the_task_are_in_it() -> None:
    tight = [{"from": "x.start", "to": "y.end", "upper": 12.0}]
    assert categorize(network(50.0, tight)) == CONSISTENT
    assert categorize(network(50.0, tight, human=(4, 9))) == CONTROLLABLE


def test_what_is_under_way_is_bounded_by_what_is_left_of_it() -> None:
    spec = task_of({"x": action("a"), "y": action("d", robot=(3, 5), after=["x"])}, deadline=20.0)
    task = load_task(spec)
    motion = acquire_motion(task, 0.4, space=False)
    problem, start = plan_problem(task, motion), beginning(task, motion)
    begun, ended, free = start.begun.copy(), start.ended.copy(), start.free.copy()
    begun[0], ended[0], free[0] = 0.0, 15.0, 15.0
    snapshot = start._replace(begun=begun, ended=ended, free=free)
    plan = plan_of(2, [], [1])
    schedule = predict(problem, snapshot, plan)
    for most, category in ((7.0, CONTROLLABLE), (7.5, CONSISTENT), (-3.0, CONTROLLABLE)):
        made = plan_network(task, plan, schedule, snapshot, 10.0, {0: (1.0, most)})
        assert categorize(made) == category
    assert categorize(plan_network(task, plan, schedule, snapshot, 21.0, {0: (1.0, 2.0)})) == INCONSISTENT
