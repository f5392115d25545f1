"""An agent that does not fit an environment is refused with what would make it fit."""

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena import agents
from lidarena.base.errors import PolicyFileError
from lidarena.envs import corridor_v0
from tests.agents.test_loading import ARENA


@pytest.mark.parametrize(
    ("name", "make", "message"),
    [
        (
            "arena",
            lambda: gym.make("lidarena/Arena-v0", action="discrete"),
            "'pretrained:arena' was trained for arena environments with observation 'way' and guard True, but this "
            "environment has observation 'ranges' and guard False; make it with observation='way', guard=True",
        ),
        (
            "arena",
            lambda: gym.make("lidarena/Arena-v0"),
            "has observation 'ranges', action 'continuous' and guard False; make it with observation='way', "
            "action='discrete', guard=True",
        ),
        (
            "low_level",
            lambda: gym.make("lidarena/Env1-v0"),
            "was trained for exploration environments with observation",
        ),
        (
            "low_level",
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
            "with neighbours 4 and guard True, but this environment has neighbours 0 and guard False; make it with",
        ),
        ("arena", lambda: gym.make("CartPole-v1"), "but this environment has observations Box"),
    ],
)
def test_what_does_not_fit_is_told_in_one_sentence(name: str, make: Any, message: str) -> None:
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


def test_pictures_may_have_their_channels_last(tmp_path: Path) -> None:
    from stable_baselines3 import PPO
    from stable_baselines3.common.envs import FakeImageEnv

    env = FakeImageEnv(screen_height=40, screen_width=48, n_channels=3, discrete=True)
    model = PPO("CnnPolicy", env, n_steps=16, batch_size=16, n_epochs=1, seed=0)
    agents.save_policy(model, tmp_path, "somewhere/Pictures-v0")
    policy = agents.load(tmp_path, env)
    picture = np.random.default_rng(0).integers(0, 255, (40, 48, 3)).astype(np.uint8)
    assert policy.act(picture, {}) == model.predict(picture, deterministic=True)[0]
