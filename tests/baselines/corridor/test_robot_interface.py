"""What a team's policies are told is the same from dictionaries and from arrays; of the finished the last is kept."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import lidarena  # noqa: F401
from lidarena.baselines.corridor.robot_interface import Fleet
from lidarena.envs import corridor_v0
from lidarena.envs.corridor.actions import commands_of
from lidarena.envs.corridor.rendering import TeamSketch
from tests.envs.corridor.corridor_worlds import EXACT

ENDS = {"starts": [(2.0, 7.5), (5.0, 7.5), (9.0, 7.0)], "goals": [(2.4, 7.5), (17.0, 7.5), (12.0, 8.0)]}
TEAM: dict[str, Any] = {"robots": 3, **ENDS, **EXACT}


def test_dictionaries_and_arrays_tell_the_same() -> None:
    env, central = corridor_v0.parallel_env(**TEAM), gym.make("lidarena/CorridorCentral-v0", **TEAM)
    one, other = Fleet(env), Fleet(central)
    infos, info = env.reset(seed=1)[1], central.reset(seed=1)[1]
    assert np.array_equal(one.grid(infos).blocked, other.grid(info).blocked)
    assert one.grid(infos).origin == other.grid(info).origin and one.grid(infos).resolution == 0.2
    commands = np.array([(0.5, 0.0), (0.3, 0.4), (0.4, -0.2)])
    for _ in range(8):
        states = one.read(infos), other.read(info)
        infos, info = env.step(one.actions(commands, states[0]))[4], central.step(other.actions(commands, states[1]))[4]
        for name in ("poses", "goals", "active", "arrived", "time"):
            assert np.allclose(getattr(states[0], name), getattr(states[1], name), atol=1e-12), name
    assert one.read(infos).arrived.tolist() == [True, False, False]


def test_of_a_finished_robot_the_last_that_was_told_is_kept_until_an_episode_begins() -> None:
    env = corridor_v0.parallel_env(**TEAM)
    fleet = Fleet(env)
    infos = env.reset(seed=1)[1]
    last = fleet.read(infos)
    while len(env.agents) == 3:
        infos = env.step(fleet.actions(np.full((3, 2), (0.5, 0.0)), last))[4]
        last = fleet.read(infos)
    for _ in range(3):
        infos = env.step(fleet.actions(np.zeros((3, 2)), last))[4]
        assert "robot_0" not in infos
        now = fleet.read(infos)
        assert np.array_equal(now.poses[0], last.poses[0]) and now.arrived[0] and not now.active[0]
        assert now.time == pytest.approx(last.time + 0.2)
        last = now
    infos = env.reset(seed=2)[1]
    fleet.begin()
    assert not fleet.read(infos).arrived.any() and fleet.read(infos).active.all()


@pytest.mark.parametrize("kind", ["continuous", "discrete"])
def test_actions_stand_for_the_commands_of_those_on_their_way(kind: str) -> None:
    env, central = (make(action=kind, **TEAM) for make in (corridor_v0.parallel_env, central_env))
    one, other = Fleet(env), Fleet(central)
    commands = np.array([(0.5, 0.0), (0.4, 1.0), (0.0, -1.5)])
    state = one.read(env.reset(seed=0)[1])
    told = one.actions(commands, state)
    assert list(told) == ["robot_0", "robot_1", "robot_2"]
    assert all(env.action_space(name).contains(action) for name, action in told.items())
    assert np.allclose(commands_of(kind, list(told.values()), 3), commands, atol=1e-6)
    array = other.actions(commands, state)
    assert central.action_space.contains(array) and np.array_equal(array, np.stack(list(told.values())))


def central_env(**keywords: Any) -> gym.Env[Any, Any]:
    return gym.make("lidarena/CorridorCentral-v0", **keywords)


@pytest.mark.parametrize("make", [corridor_v0.parallel_env, central_env])
def test_sketches_reach_the_picture_of_worlds_that_are_drawn(make: Any) -> None:
    assert not Fleet(make(**TEAM)).drawn
    env = make(render_mode="rgb_array", **TEAM)
    fleet = Fleet(env)
    env.reset(seed=0)
    before = env.render()
    fleet.show(TeamSketch({1: np.array([(5.0, 7.5), (9.0, 7.5)])}, note="a note"))
    assert fleet.drawn and (env.render() != before).any()


def test_what_planners_need_to_know_of_the_robots_is_the_environments() -> None:
    fleet = Fleet(corridor_v0.parallel_env(robots=2, robot={"radius": 0.2}, decision_period=0.1, goal_tolerance=0.3))
    assert (fleet.robots, fleet.radius, fleet.period, fleet.tolerance) == (2, 0.2, 0.1, 0.3)
    assert fleet.action == "continuous"
