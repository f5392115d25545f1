from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

from lidarena import agents
from lidarena.agents.exploration.goal_choice_agent import GoalChoiceAgent
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import check_config
from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.participants import make_participants

MAZE = "maze:5?width=5&height=5"


def test_an_agent_is_trained_saved_loaded_and_driven(tmp_path: Path) -> None:
    content = {
        "env": {"id": "lidarena/GoalChoice-v0", "keywords": {"map": MAZE, "particles": 5}},
        "total_steps": 16,
        "num_envs": 2,
        "ppo": {"n_steps": 8, "batch_size": 16, "n_epochs": 1},
        "policy": {"class": "CandidatePolicy", "net_arch": [8]},
        "out": str(tmp_path / "run"),
    }
    folder = agents.train(check_config(content, TrainingConfig), progress=False)
    env, policy = make_participants(
        EnvEntry(id="lidarena/Exploration-v0", keywords={"map": MAZE}), PolicyEntry(name="own", path=str(folder))
    )
    assert isinstance(policy, GoalChoiceAgent)
    paths = []
    for _ in range(2):
        observation, info = env.reset(seed=3)
        policy.reset(seed=0)
        for _ in range(60):
            observation, _, _, _, info = env.step(policy.act(observation, info))
        paths.append(info["pose"])
    assert np.array_equal(*paths) and not policy.finished


def test_how_small_frontiers_are_left_is_told_at_run_time() -> None:
    env = gym.make("lidarena/Exploration-v0", map=MAZE, slam="truth", stop_at=None, max_episode_steps=1500)
    paths = []
    for least in (0.1, 1.5):
        policy = agents.load("pretrained:combined", env, options={"preference": 0.0, "least_frontier": least})
        observation, info = env.reset(seed=1)
        policy.reset()
        while not policy.finished:  # type: ignore[attr-defined]
            observation, _, _, _, info = env.step(policy.act(observation, info))
        paths.append(info["path_length"])
    assert paths[1] < paths[0]
    with pytest.raises(ConfigError, match=r"least_frontier.*0\.05"):
        agents.load("pretrained:combined", env, options={"least_frontier": 0.0})
