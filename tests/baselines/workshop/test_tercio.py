import itertools

import numpy as np
import pytest

from lidarena.baselines.workshop.robot_interface import Situation
from lidarena.baselines.workshop.tercio import AllocatedSequence
from lidarena.envs.workshop.env import WorkshopEnv
from tests.envs.workshop.workshops import Sleeper, action, play, task_of


def test_the_allocation_has_the_least_largest_load() -> None:
    rng = np.random.default_rng(0)
    for _ in range(5):
        times = rng.integers(3, 20, (2, 5))
        task = task_of({f"x{k}": action("a", human=(h, h), robot=(r, r)) for k, (h, r) in enumerate(times.T.tolist())})
        env = WorkshopEnv(task=task, human=Sleeper)
        policy = AllocatedSequence(env)
        _, info = env.reset(seed=0)
        owner = policy.allocate(Situation.read(info))
        load = max(times[0, owner == 0].sum(), times[1, owner == 1].sum())
        every = [
            max(sum(times[0, k] for k in range(5) if o[k] == 0), sum(times[1, k] for k in range(5) if o[k] == 1))
            for o in itertools.product((0, 1), repeat=5)
        ]
        assert load == min(every)


def test_capability_is_kept_and_everything_is_done() -> None:
    env = WorkshopEnv(task="gearbox", human="free")
    policy = AllocatedSequence(env)
    _, info = env.reset(seed=0)
    owner = policy.allocate(Situation.read(info))
    assert owner[0] == 1 and owner[5] == 0  # the housing is the robot's, the seals are the human's
    assert play(env, lambda info: policy.act(None, info), seed=1)[-1]["success"]


def test_locations_near_the_human_are_left_out() -> None:
    task = task_of({"x": action("a", robot=None), "y": action("b", human=None), "z": action("d", human=None)},
                   locations={"a": [1, 5], "b": [1.6, 5], "d": [7, 5]})  # fmt: skip
    env = WorkshopEnv(task=task, human=lambda info, rng: 0 if info["status"][0] == 0 else None)
    policy = AllocatedSequence(env)
    _, info = env.reset(seed=0)
    now = Situation.read(info)
    assert policy._too_near(now, 1) and not policy._too_near(now, 2)
    assert policy.act(None, info) == pytest.approx(2)
