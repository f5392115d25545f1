"""A batch of robots that share one policy is the teams, robot by robot."""

import gymnasium as gym
import numpy as np
import pytest

import lidarena  # noqa: F401
from lidarena.base.errors import ConfigError
from lidarena.envs import corridor_v0

ROBOTS = 3


def shared(teams: int, **keywords: object) -> gym.vector.VectorEnv:
    return gym.make_vec("lidarena/CorridorShared-v0", teams * ROBOTS, "vector_entry_point", robots=ROBOTS, **keywords)


def test_a_team_of_the_batch_is_the_team_with_its_seed() -> None:
    batch, rng = shared(2), np.random.default_rng(0)
    observations, _ = batch.reset(seed=5)
    fleet = corridor_v0.parallel_env(robots=ROBOTS)
    own, _ = fleet.reset(seed=6)  # the second team's
    for _ in range(20):
        if len(fleet.agents) < ROBOTS:
            break
        assert all(np.array_equal(observations[ROBOTS + k], own[name]) for k, name in enumerate(fleet.agents))
        actions = rng.uniform(-1, 1, (2 * ROBOTS, 2)).astype(np.float32)
        team = {name: actions[ROBOTS + k] for k, name in enumerate(fleet.agents)}
        observations, rewards, *_ = batch.step(actions)
        own, own_rewards, *_ = fleet.step(team)
        assert rewards[ROBOTS:].tolist() == pytest.approx([own_rewards[name] for name in team])


def test_a_team_ends_together() -> None:
    batch, rng = shared(2, max_episode_steps=15), np.random.default_rng(1)
    batch.reset(seed=0)
    ended = 0
    for _ in range(40):
        _, _, terminated, truncated, _ = batch.step(rng.uniform(-1, 1, (2 * ROBOTS, 2)).astype(np.float32))
        over = (terminated | truncated).reshape(2, ROBOTS)
        assert (over.all(axis=1) == over.any(axis=1)).all()
        assert not (terminated & truncated).any()
        ended += int(over.any(axis=1).sum())
    assert ended >= 4


def test_robots_that_make_up_no_whole_teams_are_refused() -> None:
    with pytest.raises(ConfigError, match="num_envs = 4 must be a multiple of the 3 robots of a team"):
        gym.make_vec("lidarena/CorridorShared-v0", 4, "vector_entry_point", robots=3)
