"""Prioritized search in the world: without noise nobody collides; who stands in the way is planned around."""

from typing import Any

import numpy as np
import pytest

import lidarena
from lidarena.baselines.corridor.team_search import SearchingFleet
from lidarena.envs import corridor_v0
from lidarena.envs.corridor.parallel_env import CorridorEnv
from tests.envs.corridor.corridor_worlds import EXACT

CHEAP: dict[str, Any] = {**EXACT, "lidar": {"beams": 4, "noise": 0.0}}
PLAN: dict[str, Any] = {"time_limit": 60.0, "iterations": 20}
HEAD_ON: dict[str, Any] = {"robots": 2, "starts": [(5.1, 7.5), (9.1, 7.5)], "goals": [(9.1, 7.5), (5.1, 7.5)]}
IN_THE_WAY: dict[str, Any] = {"robots": 2, "starts": [(5.1, 7.5), (7.1, 7.5)], "goals": [(9.1, 7.5), (12.1, 7.5)]}
"""Robot 0 cannot go straight on before robot 1 does."""


def make(keywords: dict[str, Any], seed: int = 0, **options: Any) -> tuple[CorridorEnv, SearchingFleet, Any]:
    env = corridor_v0.parallel_env(**keywords | CHEAP)
    policy = lidarena.baselines.make("prioritized_search", env, **PLAN | options)
    infos = env.reset(seed=seed)[1]
    policy.reset(seed)
    return env, policy, infos


def held(env: CorridorEnv, policy: SearchingFleet, infos: Any, stands: set[str], steps: int) -> Any:
    """Drive, but for some robots whose wheels do nothing; the last infos."""
    for _ in range(steps):
        if env.agents:
            actions = policy.act({}, infos)
            actions |= {name: np.zeros(2, np.float32) for name in stands & set(actions)}
            infos = env.step(actions)[4]
    return infos


@pytest.mark.parametrize(
    ("name", "robots", "seed"), [("office", 6, 0), ("unstructured", 8, 1), ("unstructured", 8, 2), ("blocked", 6, 0)]
)
def test_without_noise_everybody_arrives_by_the_order_of_one_plan_and_nobody_collides(
    name: str, robots: int, seed: int
) -> None:
    env, policy, infos = make({"map": name, "robots": robots}, seed)
    held(env, policy, infos, set(), 400)
    assert env.episodes.arrived.all() and not env.episodes.touches.any()
    assert policy.replans == 0


def test_no_robot_is_ahead_of_the_plans_order_at_any_time() -> None:
    env, policy, infos = make({"map": "office", "robots": 6}, 3)
    infos = held(env, policy, infos, set(), 1)
    order = policy.ordered._precedence
    completed = policy.ordered.completed.copy()
    while env.agents:
        infos = held(env, policy, infos, set(), 1)
        for robot, (before, after) in enumerate(zip(completed, policy.ordered.completed, strict=True)):
            for step in range(before, after):
                if not env.episodes.arrived[0, robot]:
                    assert not len(order.blocking_agents(robot, step, policy.ordered.completed))
        completed = policy.ordered.completed.copy()
    assert policy.replans == 0


def test_a_team_that_nobody_lets_move_is_planned_anew_but_not_at_once_and_not_without_end() -> None:
    env, policy, infos = make(HEAD_ON)
    infos = held(env, policy, infos, {"robot_0", "robot_1"}, 14)
    assert policy.replans == 0
    infos = held(env, policy, infos, {"robot_0", "robot_1"}, 60)
    assert policy.replans <= 74 * 0.2 / 2.0  # at most one plan every 2 s
    held(env, policy, infos, set(), 300)
    assert env.episodes.arrived.all() and not env.episodes.touches.any()


@pytest.mark.parametrize("replan", [True, False])
def test_only_who_may_plan_anew_gets_past_one_that_stands_in_the_way(replan: bool) -> None:
    env, policy, infos = make(IN_THE_WAY, replan=replan)
    held(env, policy, infos, {"robot_1"}, 120)
    assert env.episodes.arrived[0].tolist() == [replan, False] and not env.episodes.touches.any()
    assert (policy.replans > 0) == replan


def test_who_stood_in_the_way_is_planned_for_again_once_it_moves() -> None:
    env, policy, infos = make(IN_THE_WAY)
    infos = held(env, policy, infos, {"robot_1"}, 60)
    planned = policy.replans
    assert planned > 0
    held(env, policy, infos, set(), 200)
    assert env.episodes.arrived.all() and policy.replans > planned


def test_one_that_crashed_is_planned_around() -> None:
    ends = {"robots": 2, "starts": [(5.1, 7.5), (7.1, 8.3)], "goals": [(9.1, 8.1), (7.1, 6.7)]}
    env, policy, infos = make(ends)
    while "robot_1" in env.agents:  # straight into the wall to the north
        actions = policy.act({}, infos)
        pose = infos["robot_1"]["pose"]
        turn = np.clip((np.pi / 2 - pose[2]) / 0.4, -1.0, 1.0)
        actions["robot_1"] = np.array([0.5 * (abs(turn) < 0.1), turn], np.float32)
        actions["robot_0"] = np.zeros(2, np.float32)
        infos = env.step(actions)[4]
    assert infos["robot_1"]["collision"]
    held(env, policy, infos, set(), 200)
    assert env.episodes.arrived[0].tolist() == [True, False]
    assert (env.episodes.touches[0] > 0).tolist() == [False, True]


def test_a_policy_may_begin_in_the_middle_of_an_episode() -> None:
    env, policy, infos = make(HEAD_ON)
    for _ in range(5):
        infos = env.step({name: np.zeros(2, np.float32) for name in env.agents})[4]
    policy.reset(0)
    held(env, policy, infos, set(), 200)
    assert env.episodes.arrived.all() and policy.replans == 0


def test_the_picture_tells_how_often_was_planned_anew() -> None:
    env, policy, infos = make(IN_THE_WAY | {"render_mode": "rgb_array"})
    infos = held(env, policy, infos, {"robot_1"}, 14)
    assert env.episodes.sketches[0].note == policy.message
    held(env, policy, infos, {"robot_1"}, 15)
    sketch = env.episodes.sketches[0]
    assert f"Replanned {policy.replans} times." in sketch.note and policy.replans > 0
    assert set(sketch.curves) <= {0, 1} and sketch.conflicts.shape == (0, 2)
