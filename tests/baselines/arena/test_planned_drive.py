"""Planning once and driving: when it plans, what it follows, and when it says that it is done."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena.baselines.arena.apf_improved import ImprovedField
from lidarena.baselines.arena.planned_drive import PlannedDrive
from lidarena.baselines.arena.robot_interface import KnownWorld
from lidarena.envs import ArenaEnv
from lidarena.world.arenas import Arena

ROOM = (0.0, 0.0, 100.0, 100.0)
PILLAR = Arena("pillar", np.array([[50.0, 50.0, 5.0]]), (10.0, 50.0), (90.0, 50.0), ROOM, 1.0)


class Given(PlannedDrive):
    """Drives along a path that a test gives it."""

    name = "given"

    def __init__(self, env: Any, path: list[tuple[float, float]], guarded: bool = True) -> None:
        self.given, self.plans = np.array(path, float), 0
        self.guarded = guarded  # type: ignore[misc]
        super().__init__(env)

    def plan(self, world: KnownWorld) -> np.ndarray:
        self.plans += 1
        return self.given


def run(policy: PlannedDrive, env: gym.Env, steps: int = 200) -> dict[str, Any]:
    observation, info = env.reset(seed=0)
    policy.reset()
    for _ in range(steps):
        action = policy.act(observation, info)
        if policy.finished:
            break
        observation, _, terminated, truncated, info = env.step(action)
        if terminated or truncated:
            break
    return info


def test_it_plans_once_an_episode() -> None:
    env = ArenaEnv(arena=PILLAR)
    policy = Given(env, [(10, 50), (50, 60), (90, 50)])
    before = policy.plans  # made once to load compiled code
    assert run(policy, env)["success"]
    assert policy.plans == before + 1
    run(policy, env)
    assert policy.plans == before + 2
    assert policy.path.tolist() == [[10, 50], [50, 60], [90, 50]]


def test_a_path_that_stops_short_is_finished_there() -> None:
    env = ArenaEnv(arena=PILLAR)
    policy = Given(env, [(10, 50), (30.5, 50)])
    info = run(policy, env)
    assert policy.finished and not info["collision"]
    assert info["pose"][0] == pytest.approx(30.0, abs=0.51)


def test_a_path_into_an_obstacle_is_driven_to_its_end_if_nothing_guards_it() -> None:
    env = ArenaEnv(arena=PILLAR)
    policy = Given(env, [(10, 50), (47, 50)], guarded=False)
    info = run(policy, env)
    assert info["collision"] and not policy.finished


def test_a_guarded_path_through_an_obstacle_hits_nothing_for_a_while() -> None:
    env = ArenaEnv(arena=PILLAR, max_episode_steps=45)
    info = run(Given(env, [(10, 50), (90, 50)]), env)
    assert not info["collision"]


def test_a_path_of_a_single_point_is_finished_at_once() -> None:
    env = ArenaEnv(arena=PILLAR)
    policy = Given(env, [(10, 50)])
    assert run(policy, env)["path_length"] == 0.0 and policy.finished


def test_a_reset_forgets_the_plan() -> None:
    env = ArenaEnv(arena=PILLAR)
    policy = Given(env, [(10, 50), (20, 50)])
    run(policy, env)
    policy.reset(seed=3)
    assert not policy.finished and policy.path.shape == (0, 2)


def test_the_improved_field_tells_its_fills() -> None:
    env = ArenaEnv(arena="yang:u")
    policy = ImprovedField(env, field={"ways": 1})
    run(policy, env)
    assert policy.fills >= 1
    policy = ImprovedField(env, field={"fill_shape": "none", "ways": 1, "attempts": 1})
    run(policy, env)
    assert policy.fills == 0 and policy.finished


def test_without_regression_search_the_walk_itself_is_driven() -> None:
    env = ArenaEnv(arena="yang:u")
    lengths = []
    for regression in (True, False):
        policy = ImprovedField(env, field={"ways": 1, "regression": regression, "repeat_regression": regression})
        info = run(policy, env, 400)
        assert info["success"]
        lengths.append(info["path_length"])
    assert lengths[0] < 0.95 * lengths[1]
