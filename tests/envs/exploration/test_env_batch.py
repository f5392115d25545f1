"""One implementation: the batch and the single environment agree to the bit, whatever the batch and the threads."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from numba import config

import lidarena  # noqa: F401
from lidarena.base.errors import ConfigError
from lidarena.base.generator_state import generator_from_words, generator_words
from lidarena.envs import BatchedExploration, set_num_threads
from tests.envs import batch_runs
from tests.envs.batch_runs import raw

STEPS = 45
KEYWORDS: list[dict[str, Any]] = [
    {},
    {"observation": "map", "reward": "d_optimality", "start": "random"},
    {"slam": "truth", "action": "continuous", "reward": "combined"},
    {"slam": "odometry"},
]


def actions_for(world: int, discrete: bool) -> np.ndarray:
    rng = np.random.default_rng(100 + world)
    return rng.integers(0, 3, STEPS) if discrete else rng.uniform(-1, 1, (STEPS, 2)).astype(np.float32)


def alone(seed: int, keywords: dict[str, Any]) -> list[bytes]:
    env = gym.make("lidarena/Env1-v0", max_episode_steps=20, **keywords)
    return batch_runs.alone(env, actions_for(seed, keywords.get("action") != "continuous"), seed)[0]


def together(count: int, keywords: dict[str, Any]) -> list[list[bytes]]:
    batch = gym.make_vec("lidarena/Env1-v0", count, "vector_entry_point", max_episode_steps=20, **keywords)
    discrete = keywords.get("action") != "continuous"
    return batch_runs.together(batch, np.stack([actions_for(k, discrete) for k in range(count)], axis=1))


@pytest.mark.parametrize("keywords", KEYWORDS, ids=["default", "map", "truth", "odometry"])
def test_world_i_of_any_batch_equals_the_single_environment_with_its_seed(keywords: dict[str, Any]) -> None:
    singles = {seed: alone(seed, keywords) for seed in (0, 1, 6, 40, 63)}
    for count in (1, 2, 7, 64):
        records = together(count, keywords)
        for seed, expected in singles.items():
            if seed < count:
                assert records[seed] == expected


def test_the_number_of_threads_changes_no_bit() -> None:
    try:
        set_num_threads(1)
        single = together(7, {})
        set_num_threads(3)
        assert together(7, {}) == single
    finally:
        set_num_threads(config.NUMBA_NUM_THREADS)


def test_stepping_leaves_pytorchs_threads_alone() -> None:
    import torch

    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        together(4, {"slam": "truth"})
        assert torch.get_num_threads() == 1
    finally:
        torch.set_num_threads(before)


def test_the_number_of_threads_is_checked() -> None:
    with pytest.raises(ConfigError, match="num_threads"):
        set_num_threads(0)


@pytest.mark.parametrize("reward", ["completeness", "combined"])
def test_a_saved_batch_continues_to_the_bit(reward: str) -> None:
    batch = BatchedExploration(5, map=["env1", "maze:2"], max_episode_steps=25, reward=reward)
    batch.reset(seed=1)
    rng = np.random.default_rng(0)
    table = rng.integers(0, 3, (60, 5))
    for actions in table[:30]:
        batch.step(actions)
    saved = batch.get_state()
    expected = [[raw(part) for part in batch.step(actions)[:2]] for actions in table[30:]]
    other = BatchedExploration(5, map=["env1", "maze:2"], max_episode_steps=25, reward=reward)
    other.set_state(saved)
    assert [[raw(part) for part in other.step(actions)[:2]] for actions in table[30:]] == expected


def test_a_generators_words_restore_it() -> None:
    rng = np.random.default_rng(5)
    rng.integers(0, 7, 3, dtype=np.uint32)
    again = generator_from_words(generator_words(rng))
    assert again.integers(0, 1000, 20).tolist() == rng.integers(0, 1000, 20).tolist()


def test_observations_are_fresh_arrays() -> None:
    batch = BatchedExploration(3, map="env1")
    first, _ = batch.reset(seed=0)
    kept = first.copy()
    batch.step(np.zeros(3, int))
    assert np.array_equal(first, kept)


@pytest.mark.parametrize("count", [0, -1, 2.5])
def test_a_batch_needs_a_whole_number_of_worlds(count: Any) -> None:
    with pytest.raises(ConfigError, match="num_envs"):
        BatchedExploration(count, map="env1")


@pytest.mark.parametrize("mode", ["sync", "async", "vector_entry_point"])
def test_make_vec_works_in_all_its_modes(mode: str) -> None:
    envs = gym.make_vec("lidarena/Env2-v0", num_envs=2, vectorization_mode=mode, slam="truth")
    observations, _ = envs.reset(seed=0)
    assert observations.shape == (2, 7)
    observations, rewards, *_ = envs.step(np.array([0, 1]))
    assert rewards.shape == (2,)
    envs.close()


def make_env1() -> gym.Env:
    return gym.make("lidarena:lidarena/Env1-v0")


def test_worlds_run_in_spawned_processes() -> None:
    envs = gym.vector.AsyncVectorEnv([make_env1] * 2, context="spawn")
    batch = BatchedExploration(2, map="env1")
    try:
        apart, _ = envs.reset(seed=3)
        assert np.array_equal(apart, batch.reset(seed=3)[0])
        actions = np.array([0, 1])
        assert np.array_equal(envs.step(actions)[0], batch.step(actions)[0])
    finally:
        envs.close()


def test_a_restored_batch_goes_on_to_the_bit_through_collisions() -> None:
    """What pymunk remembers of a wall that was hit must not outlive the episode, let alone the state."""

    def make() -> gym.vector.VectorEnv:
        return gym.make_vec(
            "lidarena/Env1-v0", num_envs=4, vectorization_mode="vector_entry_point", start="random", particles=3
        )

    envs, rng, collisions = make(), np.random.default_rng(1), 0
    envs.reset(seed=0)
    for _ in range(60):
        envs.step(rng.choice(3, 4, p=[0.5, 0.25, 0.25]))
    other = make()
    other.reset(seed=9)
    other.set_state({name: np.array(value) for name, value in envs.get_state().items()})  # type: ignore[attr-defined]
    for _ in range(80):
        actions = rng.choice(3, 4, p=[0.5, 0.25, 0.25])
        one, two = envs.step(actions), other.step(actions)
        collisions += int(one[2].sum())
        for name, value in envs.get_state().items():  # type: ignore[attr-defined]
            if name != "fields.tiles":  # of which those in use are restored
                assert np.array_equal(value, other.get_state()[name]), name  # type: ignore[attr-defined]
        assert np.array_equal(one[0], two[0]) and np.array_equal(one[1], two[1])
    assert collisions > 3
