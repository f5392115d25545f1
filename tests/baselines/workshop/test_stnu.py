"""The dispatcher: completion whatever the human does, and the ranking in three categories."""

import time
from typing import Any

import numpy as np
import pytest

import lidarena
from lidarena.baselines.workshop.robot_interface import Situation
from lidarena.baselines.workshop.stnu import TemporalDispatcher
from lidarena.envs.workshop.compiler.networks import CONTROLLABLE, INCONSISTENT
from lidarena.envs.workshop.env import WorkshopEnv
from tests.envs.workshop.workshops import Rebel, Sleeper, action, chain, loose, play, task_of


@pytest.fixture(autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LIDARENA_CACHE", str(tmp_path_factory.getbasetemp() / "plans"))


def drive(task: Any, human: Any, seeds: int = 4, **options: Any) -> list[dict[str, Any]]:
    env = WorkshopEnv(task=task, human=human)
    policy = lidarena.baselines.make("stnu", env, **options)
    ends = []
    for seed in range(seeds):
        policy.reset(seed=seed)
        ends.append(play(env, lambda info: policy.act(None, info), seed=seed)[-1])
    return ends


@pytest.mark.parametrize("human", ["free", "helpful", "stubborn", "slow", "absent", "mixture"])
@pytest.mark.parametrize("task", ["pile", "gearbox", "cabinet"])
def test_everything_is_done_with_every_human(task: str, human: str) -> None:
    assert all(info["success"] for info in drive(task, human))


@pytest.mark.parametrize("human", [Sleeper, Rebel])
def test_it_goes_on_with_what_is_left_when_no_plan_has_it(human: Any) -> None:
    task = task_of({"x": action("a"), "y": action("b", after=["x"]), "z": action("c", human=None, after=["y"])})
    assert all(info["success"] for info in drive(task, human, 2))
    env = WorkshopEnv(task=task, human=Rebel)
    policy = TemporalDispatcher(env)
    play(env, lambda info: policy.act(None, info))
    assert policy.unmatched > 0


def test_a_passed_deadline_changes_the_category_and_nothing_else() -> None:
    env = WorkshopEnv(task=loose(3) | {"deadline": 25.0}, human=Sleeper)
    policy = TemporalDispatcher(env)
    categories = []

    def act(info: dict[str, Any]) -> int:
        choice = policy.act(None, info)
        categories.append(policy.category)
        return choice

    last = play(env, act)[-1]
    assert last["success"] and not last["deadline_met"]
    assert categories[0] == CONTROLLABLE and categories[-1] == INCONSISTENT


def test_plans_that_contradict_what_was_seen_are_dropped() -> None:
    env = WorkshopEnv(task=chain(4), human="free")
    policy = TemporalDispatcher(env)
    infos = play(env, lambda info: policy.act(None, info), seed=1)
    counts = []
    for info in infos[:-1]:
        now = Situation.read(info)
        left = policy._agreeing(now)
        counts.append(len(left))
        assert all(set(plan[plan >= 0]) == set(np.flatnonzero(info["status"] == 0)) for plan in left)
    assert counts[0] == 8 and (np.diff(counts) <= 0).all()  # of 16: the human has begun the first


def test_space_is_thought_of_unless_it_is_switched_off() -> None:
    """Two equal actions, one beside the robot and one across the room."""
    task = task_of({"far": action("a", robot=(5, 6), human=None), "near": action("d", robot=(5, 6), human=None),
                    "last": action("d", robot=(5, 6), human=None, after=["near"]),
                    "over": action("a", robot=(5, 6), human=None, after=["far"])})  # fmt: skip
    spans = [drive(task, Sleeper, 1, motion=motion)[0]["makespan"] for motion in (True, False)]
    assert spans[0] < spans[1]


def test_a_decision_takes_milliseconds() -> None:
    env = WorkshopEnv(task="cabinet", human="free")
    policy = TemporalDispatcher(env)
    play(env, lambda info: policy.act(None, info))  # compiles
    times = []

    def act(info: dict[str, Any]) -> int:
        begin = time.thread_time()
        choice = policy.act(None, info)
        times.append(time.thread_time() - begin)
        return choice

    play(env, act, seed=1)
    assert np.mean(times) < 0.02


def test_options_are_checked() -> None:
    with pytest.raises(lidarena.base.errors.ConfigError, match="motion"):
        lidarena.baselines.make("stnu", WorkshopEnv(), motion=3)
    with pytest.raises(lidarena.base.errors.ConfigError, match="workshop environments only"):
        import gymnasium as gym

        lidarena.baselines.make("stnu", gym.make("lidarena/Arena-v0"))
