import numpy as np
import pytest

from lidarena.envs.exploration.goal_choice.env import BatchedGoalChoice
from lidarena.envs.worker_threads import set_num_threads


def drive(threads: int) -> list[np.ndarray]:
    set_num_threads(threads)
    batch = BatchedGoalChoice(4, map="random:maze?area_min=20&area_max=25", start="random", slam="rbpf", particles=5)
    batch.reset(seed=5)
    return [batch.step(np.full(4, k % 2))[0] for k in range(8)]


def test_threads_change_nothing() -> None:
    try:
        assert all(np.array_equal(one, two) for one, two in zip(drive(1), drive(3), strict=True))
    finally:
        set_num_threads(2)


@pytest.mark.parametrize("slam", ["truth", "odometry"])
def test_worlds_that_wait_for_their_choice_stand_still(slam: str) -> None:
    batch = BatchedGoalChoice(3, map="env2", slam=slam, expose_truth=True)
    batch.reset(seed=1)
    before = batch.episodes._steps.copy()
    batch.step(np.zeros(3, np.int64))
    driven = batch.episodes._steps - before
    assert (driven >= 1).all() and (driven <= 10).all()
