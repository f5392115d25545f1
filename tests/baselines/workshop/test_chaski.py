from typing import Any

import pytest

from lidarena.baselines.workshop.chaski import FeasiblePlans
from lidarena.envs.workshop.env import WorkshopEnv
from tests.envs.workshop.workshops import Sleeper, loose, play


@pytest.fixture(autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LIDARENA_CACHE", str(tmp_path_factory.getbasetemp() / "plans"))


def drive(task: Any, human: Any, seed: int = 0) -> tuple[FeasiblePlans, dict[str, Any]]:
    env = WorkshopEnv(task=task, human=human)
    policy = FeasiblePlans(env, motion=True)
    return policy, play(env, lambda info: policy.act(None, info), seed=seed)[-1]


def test_with_a_human_who_keeps_to_the_plans_it_is_done_in_time() -> None:
    policy, info = drive("gearbox", "helpful")
    assert info["success"] and info["deadline_met"] and policy.stranded == 0


def test_without_a_feasible_plan_it_waits_and_counts() -> None:
    policy, info = drive(loose(3) | {"deadline": 25.0}, Sleeper)
    assert not info["success"] and 0.0 < info["completion"] < 1.0 and policy.stranded > 5
    policy.reset()
    assert policy.stranded == 0
