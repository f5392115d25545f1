"""`agents.load(name, env)` gives a ready policy, or says in one sentence what the agent was trained for."""

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena import agents
from lidarena.agents.corridor.shared_fleet_agent import SharedFleetAgent
from lidarena.agents.exploration.goal_choice_agent import GoalChoiceAgent
from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.base.errors import PolicyFileError
from lidarena.envs import corridor_v0
from tests.agents.training_cases import small

ARENA = {"observation": "proximity", "action": "discrete", "knowledge": "lidar"}


def test_without_an_environment_it_is_the_network() -> None:
    assert all(type(agents.load(f"pretrained:{name}")) is LearnedPolicy for name in agents.pretrained())


@pytest.mark.parametrize(
    ("name", "make", "kind"),
    [
        ("arena", lambda: gym.make("lidarena/Arena-v0", **ARENA), LearnedPolicy),
        ("compass", lambda: gym.make("lidarena/Env2-v0", observation="frontier_histogram"), LearnedPolicy),
        ("combined", lambda: gym.make("lidarena/Env2-v0"), GoalChoiceAgent),
        ("combined", lambda: gym.make("lidarena/Env2-v0", observation="map", action="continuous"), GoalChoiceAgent),
        ("combined", lambda: gym.make("lidarena/GoalChoice-v0", map="env2"), LearnedPolicy),
        ("corridor", lambda: corridor_v0.parallel_env(neighbours=2), SharedFleetAgent),
        ("corridor", lambda: gym.make("lidarena/CorridorCentral-v0", neighbours=2), SharedFleetAgent),
    ],
)
def test_a_ready_policy_acts_whatever_its_kind(name: str, make: Any, kind: type[Any]) -> None:
    env = make()
    policy = agents.load(f"pretrained:{name}", env)
    assert type(policy) is kind
    observation, info = env.reset(seed=3)
    policy.reset(seed=0)
    for _ in range(3):
        observation, *_, info = env.step(policy.act(observation, info))
    env.close()


def test_wrappers_are_looked_through() -> None:
    class Own(gym.Wrapper[Any, Any, Any, Any]):
        pass

    env = Own(gym.make("lidarena/Arena-v0", **ARENA))
    assert type(agents.load("pretrained:arena", env)) is LearnedPolicy
    with pytest.raises(PolicyFileError, match="observation 'proximity'"):
        agents.load("pretrained:arena", Own(gym.make("lidarena/Arena-v0", action="discrete")))


@pytest.mark.parametrize(
    ("name", "make", "message"),
    [
        (
            "arena",
            lambda: gym.make("lidarena/Arena-v0", action="discrete"),
            "'pretrained:arena' was trained for arena environments with observation 'proximity', but this environment "
            "has observation 'ranges'; make it with observation='proximity'",
        ),
        (
            "arena",
            lambda: gym.make("lidarena/Arena-v0"),
            "with observation 'proximity' and action 'discrete', but this environment has observation 'ranges' and "
            "action 'continuous'; make it with observation='proximity', action='discrete'",
        ),
        (
            "compass",
            lambda: gym.make("lidarena/Env1-v0"),
            "was trained for exploration environments with observation",
        ),
        (
            "compass",
            lambda: gym.make("lidarena/Arena-v0"),
            "was trained for exploration environments, but this one is of the family 'arena'",
        ),
        (
            "combined",
            lambda: gym.make("lidarena/Arena-v0"),
            "was trained for exploration environments, but this one is of the family 'arena'",
        ),
        (
            "corridor",
            lambda: corridor_v0.parallel_env(),
            "with neighbours 2, but this environment has neighbours 0; make it with neighbours=2",
        ),
        ("arena", lambda: gym.make("CartPole-v1"), "but this environment has observations Box"),
    ],
)
def test_a_misfit_is_told_in_one_sentence(name: str, make: Any, message: str) -> None:
    with pytest.raises(PolicyFileError) as refusal:
        agents.load(f"pretrained:{name}", make())
    assert message in str(refusal.value) and "\n" not in str(refusal.value)


def test_the_same_shape_is_not_the_same_observation() -> None:
    env = gym.make("lidarena/Arena-v0", **ARENA)
    learned = agents.load("pretrained:arena")
    learned.env_keywords = {**learned.env_keywords, "observation": "ranges"}
    assert learned.observation_space == env.observation_space
    with pytest.raises(PolicyFileError, match="with observation 'ranges'"):
        agents.ready(learned, env)


def test_keywords_that_are_only_of_the_training_do_not_matter() -> None:
    env = gym.make("lidarena/Arena-v0", **ARENA, reward={"progress": 2.0}, density=0.1)
    learned = agents.load("pretrained:arena")
    learned.env_keywords = {**learned.env_keywords, "arena": "barn", "path": "/not/here", "robot": {"max_speed": -3}}
    assert agents.ready(learned, env) is learned


def test_arenas_of_another_scale_and_their_lidar_are_the_same_to_an_agent() -> None:
    env = gym.make("lidarena/Arena-v0", arena="env2", start=(1.0, 1.0), goal=(5.0, 6.0), **ARENA)
    assert agents.ready(agents.load("pretrained:arena"), env) is not None


def test_an_agent_of_a_strangers_environment(tmp_path: Path) -> None:
    env_id = "tests.agents.fake_single:stranger/Walk-v0"
    folder = agents.train(small(tmp_path / "run", f"env.id={env_id}", "total_steps=64"), progress=False)
    env = gym.make(env_id)
    policy = agents.load(folder, env)
    observation, info = env.reset(seed=0)
    assert policy.act(observation, info) in (0, 1)
    with pytest.raises(PolicyFileError, match="has observations Box"):
        agents.load(folder, gym.make("CartPole-v1"))


def test_pictures_may_have_their_channels_last(tmp_path: Path) -> None:
    from stable_baselines3 import PPO
    from stable_baselines3.common.envs import FakeImageEnv

    env = FakeImageEnv(screen_height=40, screen_width=48, n_channels=3, discrete=True)
    model = PPO("CnnPolicy", env, n_steps=16, batch_size=16, n_epochs=1, seed=0)
    agents.save_policy(model, tmp_path, "somewhere/Pictures-v0")
    policy = agents.load(tmp_path, env)
    picture = np.random.default_rng(0).integers(0, 255, (40, 48, 3)).astype(np.uint8)
    assert policy.act(picture, {}) == model.predict(picture, deterministic=True)[0]
