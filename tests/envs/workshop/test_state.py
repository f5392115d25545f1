import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.envs.workshop.options import WorkshopOptions
from lidarena.envs.workshop.state import WorkshopCore
from lidarena.envs.workshop.task import HUMAN, ROBOT
from tests.envs.workshop.workshops import loose


def core(worlds: int = 2, **keywords: object) -> WorkshopCore:
    made = WorkshopCore(worlds, WorkshopOptions.checked({"task": loose(3)} | keywords))
    for world in range(worlds):
        made.reset_world(world, np.random.default_rng(world))
    made.run(np.ones(worlds, np.bool_))
    return made


def test_a_reset_world_runs_up_to_the_robots_decision() -> None:
    made = core()
    assert made.workers.due[:, ROBOT].all() and (made.workers.action[:, HUMAN] >= 0).all()
    assert (made.time == 0.0).all() and made.rules.keep == pytest.approx(0.9)


def test_what_may_not_be_begun_is_waited_for_and_told() -> None:
    made = core()
    taken = made.workers.action[:, HUMAN].copy()
    refused = made.decide(ROBOT, taken, np.array([True, False]))
    assert refused.tolist() == [True, False]
    assert made.workers.asleep[:, ROBOT].tolist() == [True, False]
    others = (taken + 1) % 3
    assert not made.decide(ROBOT, others, np.array([False, True])).any()
    assert made.workers.action[1, ROBOT] == others[1]


def test_arrays_continue_another_core() -> None:
    first, second = core(), core()
    first.decide(ROBOT, np.array([3, 3]), np.ones(2, np.bool_))
    first.run(np.ones(2, np.bool_))
    second.load_arrays({name: array.copy() for name, array in first.arrays().items()})
    for made in (first, second):
        made.decide(ROBOT, np.array([3, 3]), np.ones(2, np.bool_))
        made.run(np.ones(2, np.bool_))
    assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(first.workers, second.workers, strict=True))


def test_arrays_of_another_task_are_refused() -> None:
    with pytest.raises(ConfigError, match="another task"):
        core(task=loose(2)).load_arrays(core().arrays())
