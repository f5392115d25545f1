"""What schedulers make of an info: who will be free when, and what is left of what is under way."""

import numpy as np
import pytest

from lidarena.baselines.workshop.robot_interface import ABSENCE, Scheduler, Situation, under_way
from lidarena.envs.workshop.compiler.compiled import plan_problem
from lidarena.envs.workshop.compiler.motion import acquire_motion
from lidarena.envs.workshop.env import WorkshopEnv
from lidarena.envs.workshop.kernels import AWAY, IDLE, WALKING, WORKING
from tests.envs.workshop.workshops import action, play, task_of

TASK = task_of({"x": action("a", human=(4, 9), robot=(5, 7)), "y": action(["d", "table"], after=["x"])})


def situation(**more: object) -> Situation:
    """The human works at x since 2 s, the robot is at home."""
    base = {
        "time": 12.0, "status": np.array([1, 0]), "agent": np.array([0, -1]), "begun": np.array([1.0, np.nan]),
        "ended": np.full(2, np.nan), "doing": np.array([0, -1]), "stop": np.zeros(2, np.int64),
        "phase": np.array([WORKING, IDLE]), "since": np.array([2.0, 5.0]), "places": np.array([[1.0, 5.0], [7.0, 1.0]]),
        "mask": np.array([False, True, True]),
    }  # fmt: skip
    return Situation(**(base | more))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def scheduler() -> Scheduler:
    return Scheduler(WorkshopEnv(task=TASK))


def test_an_info_is_read() -> None:
    info = play(WorkshopEnv(task=TASK, human="free"), seed=0)[1]
    now = Situation.read(info)
    assert now.wait == 2 and now.time == info["time"] and now.human_acts == (info["doing"][0] >= 0)
    assert set(now.order_of(0)) | set(now.order_of(1)) == set(np.flatnonzero(info["status"] > 0))
    assert under_way(now).tolist() == np.flatnonzero(info["status"] == 1).tolist()


def test_who_works_is_free_when_the_usual_time_is_over(scheduler: Scheduler) -> None:
    motion = acquire_motion(scheduler.task, 0.4)
    problem = plan_problem(scheduler.task, motion)
    seen = scheduler.snapshot(situation(), problem, motion)
    assert seen.free[0] == seen.ended[0] == pytest.approx(12.0 + 6.0 - 2.0)
    assert seen.free[1] == 12.0 and seen.place.tolist() == [0, -1] and seen.begun[1] == np.inf
    assert seen.first[1, 3] == pytest.approx(4.0 / 0.5, rel=0.05)
    late = scheduler.snapshot(situation(since=np.array([50.0, 5.0])), problem, motion)
    assert late.free[0] == pytest.approx(13.0)  # overdue: any moment now
    walking = scheduler.snapshot(
        situation(phase=np.array([WALKING, IDLE]), places=np.array([[1.0, 2.0], [7.0, 1.0]])), problem, motion
    )
    assert walking.free[0] == pytest.approx(12.0 + 3.0 + 6.0, rel=0.02)


def test_who_is_away_is_expected_back(scheduler: Scheduler) -> None:
    motion = acquire_motion(scheduler.task, 0.4, space=False)
    now = situation(status=np.zeros(2, np.int64), doing=np.array([-1, -1]), phase=np.array([AWAY, IDLE]))
    assert scheduler.snapshot(now, plan_problem(scheduler.task, motion), motion).free[0] == 12.0 + ABSENCE


def test_what_is_left_is_bounded(scheduler: Scheduler) -> None:
    assert scheduler.left_of(situation(), 0) == pytest.approx((2.0, 7.0))
    low, high = scheduler.left_of(situation(phase=np.array([WALKING, IDLE]), places=np.array([[1.0, 2.0], [7, 1]])), 0)
    assert low == pytest.approx(4.0 + 3.0, rel=0.02) and high == pytest.approx(9.0 + 3.3, rel=0.02)
    assert scheduler.left_of(situation(since=np.array([11.0, 0.0])), 0)[1] < 0.0
