from typing import Any

import numpy as np
import pytest

from lidarena.envs.workshop.env import WorkshopEnv
from lidarena.envs.workshop.observations import OF_ALL, PER_ACTION
from tests.envs.workshop.workshops import Sleeper, action, loose, play, task_of

TASK = task_of({"x": action("a", robot=None), "y": action("d", human=None), "z": action("c", after=["y"])})


def test_blocks_tell_of_the_actions() -> None:
    env = WorkshopEnv(task=TASK, human=Sleeper)
    seen, _ = env.reset(seed=0)
    assert seen.shape == (3 * PER_ACTION + OF_ALL,) and env.observation_space.contains(seen)
    x, y, z = seen[: 3 * PER_ACTION].reshape(3, PER_ACTION)
    assert x[[0, 3, 4]].tolist() == [1, 0, 1] and y[[0, 3, 4]].tolist() == [1, 1, 0]
    assert z[[3, 4]].tolist() == [0, 0] and z[12] == pytest.approx(1 / 3)
    assert y[6] == pytest.approx(8.0 / 20.0, rel=0.1) and y[7] == pytest.approx(np.sqrt(35) / 30)
    assert y[8] == y[9] == 0.0 and x[6] == x[7] == 0.0
    seen, *_ = env.step(1)
    y, z = seen[PER_ACTION : 2 * PER_ACTION], seen[2 * PER_ACTION : 3 * PER_ACTION]
    assert y[0] == y[1] == 0.0 and z[3] == 1.0 and z[12] == 0.0  # y is done by now


def test_the_whole_is_told_within_its_space() -> None:
    env = WorkshopEnv(task="gearbox", human="slow")
    env.reset(seed=1)
    last = play(env, seed=1)[-1]
    seen = env.episodes.observe()[0]
    assert np.isfinite(seen).all() and seen[-OF_ALL] == pytest.approx(last["time"] / env.task.deadline, rel=1e-5)
    assert seen[-OF_ALL + 6] > 1.0  # the human's pace
    assert seen[-OF_ALL + 8] == 0.0  # nothing is left


def test_what_the_human_passed_over_and_declined_is_remembered() -> None:
    def second_or_rest(info: dict[str, Any], rng: np.random.Generator) -> int | None:
        return 1 if info["allowed_human"][1] else None

    env = WorkshopEnv(task=loose(3), human=second_or_rest)
    seen, info = env.reset(seed=0)
    blocks = seen[: 3 * PER_ACTION].reshape(3, PER_ACTION)
    assert blocks[:, 13] == pytest.approx([1 / 3, 0, 1 / 3]) and not blocks[:, 14].any()
    while info["status"][1] != 2:
        seen, _, _, _, info = env.step(3)
    blocks = seen[: 3 * PER_ACTION].reshape(3, PER_ACTION)
    assert blocks[:, 14] == pytest.approx([1 / 3, 0, 1 / 3]) and blocks[0, 13] == pytest.approx(1 / 3)
