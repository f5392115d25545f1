"""Planned fleets in the world: they arrive, as dictionaries or arrays; nobody passes out of turn; failures are told."""

import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.base.errors import ConfigError
from lidarena.baselines.corridor.team_driving import ClockDriving, steer_to
from lidarena.envs import corridor_v0

HEAD_ON = {"starts": [(5.0, 7.5), (9.0, 7.5)], "goals": [(9.0, 7.5), (5.0, 7.5)], "robots": 2}


def run(env, policy, seed=0, steps=1000):
    """Drive a parallel environment to its end; return the team's measures."""
    observations, infos = env.reset(seed=seed)
    policy.reset(seed)
    for _ in range(steps):
        if not env.agents:
            break
        actions = policy.act(observations, infos)
        if policy.finished:
            break
        observations, _, _, _, infos = env.step(actions)
    return {name: float(value[0]) for name, value in env.episodes.measures().items()}


@pytest.mark.parametrize("name", ["prioritized_astar", "coordination", "joint_astar", "prioritized_search"])
def test_two_robots_that_meet_in_the_corridor_get_past_each_other(name):
    env = corridor_v0.parallel_env(**HEAD_ON)
    if name == "coordination":  # on one line there is no timing
        env = corridor_v0.parallel_env(robots=2)
    policy = lidarena.baselines.make(name, env)
    measures = run(env, policy, seed=2)
    assert measures["all_arrived"] == 1.0 and measures["collided"] == 0.0, policy.message


def test_independent_robots_collide_head_on():
    env = corridor_v0.parallel_env(**HEAD_ON)
    assert run(env, lidarena.baselines.make("independent_astar", env))["collided"] == 1.0


@pytest.mark.parametrize("name", ["passing", "blocked"])
def test_the_search_solves_what_fixed_priorities_or_paths_do_not(name):
    env = corridor_v0.parallel_env(map=name, robots=2 if name == "passing" else 6)
    policy = lidarena.baselines.make("coordination", env)
    run(env, policy)
    assert policy.finished and policy.message.startswith("Robot ") and "coordination diagram" in policy.message
    measures = run(env, lidarena.baselines.make("prioritized_search", env))
    assert measures["all_arrived"] == 1.0 and measures["collided"] == 0.0


def test_a_robot_in_trouble_is_planned_around():
    """Robot 1 never moves again; robot 0 has to get past it, and does."""
    ends = {"starts": [(5.0, 7.5), (7.0, 7.5)], "goals": [(9.0, 7.5), (3.0, 7.5)]}
    env = corridor_v0.parallel_env(robots=2, max_cycles=500, **ends)
    policy = lidarena.baselines.make("prioritized_search", env)
    observations, infos = env.reset(seed=0)
    policy.reset(0)
    arrived = False
    while env.agents and not arrived:
        actions = policy.act(observations, infos)
        if "robot_1" in actions:
            actions["robot_1"] = np.zeros(2, np.float32)
        observations, _, _, _, infos = env.step(actions)
        arrived = infos.get("robot_0", {"success": False})["success"]
    assert arrived and policy.replans >= 1 and not env.episodes.touches.any()


def test_the_same_policies_drive_for_one_controller():
    env = gym.make("lidarena/CorridorCentral-v0", robots=3, render_mode="rgb_array")
    policy = lidarena.baselines.make("prioritized_search", env)
    observation, info = env.reset(seed=1)
    policy.reset(1)
    terminated = False
    while not terminated:
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        assert not truncated
    assert info["measures"]["arrival"] == 1.0 and env.render().dtype == np.uint8


def test_a_plan_and_who_waits_are_seen_in_the_picture():
    env = corridor_v0.parallel_env(render_mode="rgb_array", robots=6)
    policy = lidarena.baselines.make("prioritized_search", env)
    observations, infos = env.reset(seed=3)
    policy.reset(3)
    waited, bare = False, env.render()
    for _ in range(150):
        observations, _, _, _, infos = env.step(policy.act(observations, infos))
        waited = waited or bool(env.episodes.sketches[0].waits)
        if not env.agents or waited:
            break
    assert waited and len(env.episodes.sketches[0].curves) >= 1
    assert bare.shape == env.render().shape


def test_discrete_actions_serve_too():
    env = corridor_v0.parallel_env(action="discrete", robots=2, places="random")
    assert run(env, lidarena.baselines.make("prioritized_search", env), seed=1)["collided"] == 0.0


def test_equal_seeds_drive_alike():
    env = corridor_v0.parallel_env(places="random")
    policy = lidarena.baselines.make("prioritized_search", env, time_limit=60.0)
    assert run(env, policy, 7) == run(env, policy, 7)


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        ("joint_astar", {}, "drives 2 robots, not 4"),
        ("independent_astar", {"planning_radius": 0.05}, r"planning_radius = 0\.05 m"),
        ("prioritized_astar", {"step": 0.0}, r"step = 0\.0 s"),
        ("prioritized_search", {"time_limit": 0.0}, r"time_limit = 0\.0 s"),
        ("prioritized_search", {"patience": 1}, "has no option 'patience'"),
    ],
)
def test_options_that_make_no_sense_are_refused(name, options, sentence):
    with pytest.raises(ConfigError, match=sentence):
        lidarena.baselines.make(name, corridor_v0.parallel_env(), **options)


def test_fleets_drive_teams_only():
    with pytest.raises(ConfigError, match="drives corridor environments only"):
        lidarena.baselines.make("prioritized_search", gym.make("lidarena/Env1-v0"))


def test_steering_turns_first_and_stops_at_the_target():
    pose = np.array([0.0, 0.0, 0.0])
    assert steer_to(pose, np.array([0.01, 0.0])) == (0.0, 0.0)
    speed, rate = steer_to(pose, np.array([-1.0, 0.2]))
    assert speed == 0.0 and rate > 0.0
    assert steer_to(pose, np.array([1.0, 0.0])) == (0.5, 0.0)


def test_the_clock_says_where_a_robot_should_be():
    driving = ClockDriving([np.array([(0.0, 0.0), (0.2, 0.0), (0.2, 0.2)])], 0.8)
    assert driving.planned(0, 0.4).tolist() == [0.1, 0.0]
    assert driving.planned(0, 99.0).tolist() == [0.2, 0.2]
