"""The shipped agents load, and drive in the environments they are for."""

import hashlib
import json
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena import agents
from lidarena.agents.exploration.goal_choice_agent import GoalChoiceAgent
from lidarena.base.errors import PolicyFileError
from lidarena.envs.corridor import SHARED_ID

GOAL_CHOICE_ID = "lidarena/GoalChoice-v0"
RECORDED = {
    "combined": ("6b7b99a570d28206", "e9840bcd380a9f23"),
    "compass": ("acf8cde9527f8bb7", "206da757d61428b5"),
    "completeness": ("fef08a23b24de84f", "7e693a01d54a9704"),
    "uncertainty": ("79c180e74b4b26e4", "5c6a1e76f5c2bf8c"),
}
"""Digests of 100 actions, the most probable and the drawn ones, as version 0.1 took them."""


def actions_of(name: str, deterministic: bool) -> list[Any]:
    """What an agent does to 100 observations of noise."""
    policy: Any = agents.load(f"pretrained:{name}", deterministic=deterministic)
    space = policy.observation_space
    low, high = np.clip(space.low, -1, 1), np.clip(space.high, -1, 1)
    observations = np.random.default_rng(0).uniform(low, high, (100, *space.shape)).astype(space.dtype)
    policy.reset(seed=0)
    return [np.asarray(policy.act(observation)).tolist() for observation in observations]


@pytest.mark.filterwarnings("ignore:.*is succeeded by")
@pytest.mark.parametrize("name", RECORDED)
def test_the_shipped_weights_act_as_in_the_first_version(name: str) -> None:
    found = [json.dumps(actions_of(name, deterministic)).encode() for deterministic in (True, False)]
    assert tuple(hashlib.sha256(actions).hexdigest()[:16] for actions in found) == RECORDED[name]


def test_the_corridor_agent_acts_as_when_it_was_shipped() -> None:
    best = [[-1.0, 0.183762], [0.346293, -0.311226], [-0.026373, -0.356858]]
    drawn = [[-0.980116, 0.156708], [0.469371, -0.289743], [-0.129319, -0.282807]]
    assert np.allclose(actions_of("corridor", True)[:3], best, atol=1e-5)
    assert np.allclose(actions_of("corridor", False)[:3], drawn, atol=1e-5)


@pytest.mark.parametrize("name", agents.pretrained())
def test_a_shipped_agent_says_how_it_was_trained(name: str) -> None:
    policy = agents.load(f"pretrained:{name}")
    assert policy.training["steps"] >= policy.training["total_steps"] > 0
    assert policy.training["seed"] is not None


@pytest.mark.parametrize("name", [name for name in agents.pretrained()])
def test_a_shipped_agent_drives(name: str) -> None:
    policy = agents.load(f"pretrained:{name}")
    if policy.env_id in (GOAL_CHOICE_ID, SHARED_ID):
        return  # tests/evaluation, and tests/agents/test_shared_fleet_agent.py, drive these
    env = gym.make(policy.env_id, **policy.env_keywords)
    agents.load(f"pretrained:{name}", env)
    observation, info = env.reset(seed=4)
    policy.reset(seed=0)
    distance = info.get("distance")
    for _ in range(20):
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        if terminated or truncated:
            break
    if "completeness" in info:
        assert info["completeness"] > 0.1
    elif "completion" in info:
        assert info["completion"] > 0.3
    elif "frame" in info:
        assert info["frame"] >= 20 * 16  # of 1,600, no step shorter than that on average
    else:
        assert info["distance"] < distance


def test_the_combined_agent_explores_a_world_that_it_was_not_trained_in() -> None:
    env = gym.make("lidarena/Env4-v0", max_episode_steps=5000, stop_at=None)
    policy = agents.load("pretrained:combined", env)
    assert isinstance(policy, GoalChoiceAgent)
    observation, info = env.reset(seed=4)
    policy.reset(seed=0)
    while True:
        action = policy.act(observation, info)
        if policy.finished:
            break
        observation, _, terminated, truncated, info = env.step(action)
        assert not (terminated or truncated)
    assert info["completeness"] > 0.98


def test_an_agent_that_was_told_other_features_is_refused_in_one_sentence() -> None:
    env = gym.make("lidarena/Env1-v0")
    with pytest.raises(PolicyFileError, match=r"trained to choose by features of shape \(112,\).*: train it anew$"):
        GoalChoiceAgent(env, agents.load("pretrained:low_level"))


@pytest.mark.parametrize("plan", ["env2", "random:furnished"])
def test_the_low_level_agent_explores_a_world_that_it_was_not_trained_in(plan: str) -> None:
    env = gym.make("lidarena/Exploration-v0", map=plan, observation="frontier_arcs", max_episode_steps=-1)
    policy = agents.load("pretrained:low_level", env)
    observation, info = env.reset(seed=2_000)
    policy.reset(seed=0)
    ended = False
    while not ended:
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        ended = terminated or truncated or info["time"] > 600.0
    assert info["completeness"] >= 0.95 and not info["collision"]


def test_the_agent_that_it_takes_the_place_of_still_drives_and_says_which_is_better() -> None:
    env = gym.make("lidarena/Env1-v0", observation="frontier_histogram")
    with pytest.warns(DeprecationWarning, match="'pretrained:compass' is succeeded by 'pretrained:low_level'"):
        policy = agents.load("pretrained:compass", env)
    observation, info = env.reset(seed=0)
    assert env.action_space.contains(policy.act(observation, info))
    assert "compass" not in agents.pretrained()


def test_an_agent_that_is_not_shipped_is_refused() -> None:
    with pytest.raises(PolicyFileError, match=r"'completness' is shipped.*completeness"):
        agents.load("pretrained:completness")
