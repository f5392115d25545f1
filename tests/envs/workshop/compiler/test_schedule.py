"""Schedules by hand, and the search against all plans."""

import numpy as np
import pytest

from lidarena.envs.workshop.compiler.compiled import beginning, plan_problem
from lidarena.envs.workshop.compiler.motion import acquire_motion
from lidarena.envs.workshop.compiler.plans import enumerate_plans
from lidarena.envs.workshop.compiler.schedule import PlanProblem, Snapshot, predict, predict_all, search_plans
from lidarena.envs.workshop.task import WorkshopTask, load_task
from tests.envs.workshop.workshops import action, chain, loose, task_of

FOUR = {"human": (4, 4), "robot": (6, 6)}


def ready(spec: object, space: bool = False) -> tuple[WorkshopTask, PlanProblem, Snapshot]:
    task = load_task(spec)
    motion = acquire_motion(task, 0.4, space)
    return task, plan_problem(task, motion), beginning(task, motion)


def plan_of(count: int, human: list[int], robot: list[int]) -> np.ndarray:
    plan = np.full((2, count), -1, np.int64)
    plan[0, : len(human)], plan[1, : len(robot)] = human, robot
    return plan


def test_a_schedule_by_hand() -> None:
    spec = task_of({name: action(["a", "table"], **FOUR, after=after) for name, after in
                    (("x", []), ("y", ["x"]), ("z", []))})  # fmt: skip
    _, problem, start = ready(spec)
    schedule = predict(problem, start, plan_of(3, [0, 2], [1]))
    assert schedule.ended == pytest.approx([4.0, 4.0 + 3.0, 8.0])  # y: half of its 6 s, a wait for x, the other half
    assert schedule.idle == pytest.approx([0.0, 1.0])
    assert predict(problem, start, plan_of(3, [1, 0, 2], [])).makespan == np.inf  # against the order
    assert predict(problem, start, plan_of(3, [], [0, 1, 2])).makespan == pytest.approx(18.0)


def test_ways_and_waiting_for_a_location_cost_time() -> None:
    spec = task_of({name: action("b", **FOUR) for name in "xy"})
    task, problem, start = ready(spec, space=True)
    human, robot = (float(start.first[agent, task.locations.index("b")]) for agent in (0, 1))
    schedule = predict(problem, start, plan_of(2, [0], [1]))
    assert schedule.ended[0] == pytest.approx(human + 4.0)
    assert schedule.ended[1] == pytest.approx(max(robot, human + 4.0) + 6.0)  # one at a time


@pytest.mark.parametrize("spec", [loose(4), chain(4), "gearbox"], ids=["loose", "chain", "gearbox"])
@pytest.mark.parametrize("space", [False, True])
def test_search_finds_the_quickest_of_all_plans(spec: object, space: bool) -> None:
    task, problem, start = ready(spec, space)
    plans = enumerate_plans(task.arrays, 3000)
    assert plans is not None
    spans = predict_all(problem, start, plans)
    found, best, complete = search_plans(problem, start, 5, 1_000_000)
    assert complete and found[0] <= spans.min() + 1e-6
    again = predict_all(problem, start, best)
    assert again[0] == pytest.approx(found[0], abs=0.01) and (np.diff(found) >= 0).all()
    assert sorted(best[0][best[0] >= 0].tolist()) == list(range(len(task.actions)))


def test_search_goes_on_from_what_has_been_done_and_stops_at_its_limit() -> None:
    _, problem, start = ready(loose(4))
    begun, ended = np.full(4, np.inf), np.full(4, np.inf)
    begun[0], ended[0] = 0.0, 30.0
    later = start._replace(free=np.array([30.0, 10.0]), begun=begun, ended=ended)
    _, plans, _ = search_plans(problem, later, 3, 100_000)
    assert (plans[0] != 0).all() and (plans[0, 1] >= 0).sum() == 3  # the robot does the rest meanwhile
    _, few, complete = search_plans(problem, start, 3, 20)
    assert not complete and len(few) <= 3
