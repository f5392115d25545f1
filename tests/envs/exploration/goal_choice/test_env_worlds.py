"""Choosing works with every robot, lidar and estimator, in worlds small and large."""

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.wrappers.vector import FlattenObservation, RecordEpisodeStatistics

from lidarena import agents
from lidarena.envs.exploration.goal_choice.features import NAMES
from lidarena.world.floorplan import Floorplan
from tests.agents.learner_cases import small
from tests.slam.ray_mapper import RayMapper

MAZE = "maze:5?width=5&height=5"
NEAREST = NAMES.index("nearest")


def explore(most: int, **keywords: Any) -> tuple[gym.Env[Any, Any], dict[str, Any]]:
    """Always go to the nearest frontier, for so many choices at most."""
    env = gym.make("lidarena/GoalChoice-v0", **{"map": MAZE, "slam": "truth"} | keywords)
    rows, info = env.reset(seed=1)
    for _ in range(most):
        assert env.observation_space.contains(rows)
        rows, reward, terminated, truncated, info = env.step(int(rows[:, NEAREST].argmax()))
        assert np.isfinite(reward)
        if terminated or truncated:
            break
    return env, info


@pytest.mark.parametrize(
    "keywords",
    [
        {"robot": "turtlebot3_waffle"},
        {"robot": "jackal", "map": "maze:5?width=7&height=7&corridor=1.4"},
        {"lidar": "hokuyo_urg_04lx"},
        {"lidar": {"beams": 24}},
        {"lidar": {"rate": 2.0}},
        {"candidates": 2},
        {"choice_period": 4.0, "decision_period": 0.4},
        {"slam": "odometry"},
        {"slam": RayMapper},
    ],
    ids=str,
)
def test_it_explores_with(keywords: dict[str, Any]) -> None:
    _, info = explore(12, **keywords)
    assert not info["collision"] and info["completeness"] > 0.3 and info["path_length"] > 0.5


def test_an_episode_without_anything_to_choose_ends_in_its_first_step() -> None:
    env = gym.make("lidarena/GoalChoice-v0", map=own_room, slam="truth")
    rows, info = env.reset(seed=0)
    assert not rows.any() and not info["action_mask"].any()
    rows, _, terminated, truncated, info = env.step(0)
    assert terminated and not truncated and info["success"] and info["completeness"] > 0.99


def own_room(rng: np.random.Generator) -> Floorplan:
    """A room that is seen at a glance."""
    walls = [(0, 0, 2, 0), (2, 0, 2, 2), (2, 2, 0, 2), (0, 2, 0, 0)]
    return Floorplan.from_shapes("room", (0, 0, 2, 2), walls, start=(1.0, 1.0, 0.0))


def test_gymnasiums_wrappers_take_a_batch() -> None:
    envs: Any = gym.make_vec("lidarena/GoalChoice-v0", 2, "vector_entry_point", autoreset_mode="NextStep", map=MAZE,
                             slam="truth", max_episode_steps=3)  # fmt: skip
    envs = RecordEpisodeStatistics(FlattenObservation(envs))
    rows, _ = envs.reset(seed=0)
    assert rows.shape == (2, 24 * (len(NAMES) + 24))
    lengths = []
    for _ in range(8):
        infos = envs.step(np.zeros(2, np.int64))[4]
        lengths += infos["episode"]["l"][infos["_episode"]].tolist() if "episode" in infos else []
    assert lengths[:2] == [3, 3]


def test_maskable_ppo_learns_from_what_there_is(tmp_path: Path) -> None:
    world = f"env.keywords={{map: '{MAZE}', slam: truth, start: random, candidates: 6}}"
    rollout = "maskable_ppo={n_steps: 8, batch_size: 16, n_epochs: 1}"
    more = ("env.id=lidarena/GoalChoice-v0", world, rollout, "total_steps=32", "num_envs=2")
    config = small(tmp_path / "run", "MaskablePPO", *more)
    policy = agents.load(agents.train(config, progress=False))
    env = gym.make("lidarena/GoalChoice-v0", map=MAZE, slam="truth", candidates=6)
    rows, info = env.reset(seed=0)
    assert info["action_mask"][policy.act(rows, info)]
