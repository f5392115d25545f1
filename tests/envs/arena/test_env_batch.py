"""The batch of arenas and the single arena agree to the bit, and a saved batch goes on to the bit."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded

import lidarena  # noqa: F401
from lidarena.base.errors import ConfigError
from lidarena.envs import BatchedArena
from tests.envs import batch_runs
from tests.envs.batch_runs import raw

STEPS = 120
KEYWORDS: list[dict[str, Any]] = [
    {"arena": "random", "density": 0.22, "arenas": 9},
    {"arena": ["yang:u", "random:3", "u_trap"], "action": "discrete", "lidar": {"noise": 0.1}},
    {
        "arena": "random",
        "expose_truth": True,
        "knowledge": "lidar",
        "reward": {"preset": "default", "turn": 1.0, "clearance": 1.0},
    },
]


def actions_for(world: int, discrete: bool) -> np.ndarray:
    rng = np.random.default_rng(100 + world)
    if discrete:
        return rng.choice([0, 0, 0, 1, 15], STEPS)
    return rng.uniform(-0.1, 0.1, (STEPS, 1)).astype(np.float32)


def alone(seed: int, keywords: dict[str, Any]) -> tuple[list[bytes], int]:
    env = gym.make("lidarena/Arena-v0", max_episode_steps=70, **keywords)
    record, endings = batch_runs.alone(env, actions_for(seed, "action" in keywords), seed)
    return record, sum(bool(info["collision"]) for info in endings)


def together(count: int, keywords: dict[str, Any]) -> list[list[bytes]]:
    batch = gym.make_vec("lidarena/Arena-v0", count, "vector_entry_point", max_episode_steps=70, **keywords)
    table = np.stack([actions_for(k, "action" in keywords) for k in range(count)], axis=1)
    return batch_runs.together(batch, table)


@pytest.mark.parametrize("keywords", KEYWORDS, ids=["random", "mixed", "truth"])
def test_world_i_of_any_batch_equals_the_single_environment_with_its_seed(keywords: dict[str, Any]) -> None:
    singles = {seed: alone(seed, keywords) for seed in (0, 1, 6, 40)}
    assert sum(collisions for _, collisions in singles.values()) >= 2
    for count in (1, 2, 7, 64):
        records = together(count, keywords)
        for seed, (expected, _) in singles.items():
            if seed < count:
                assert records[seed] == expected


def test_by_seed_holds_for_batches_too() -> None:
    batch = BatchedArena(3, arena="u_trap", pick="by_seed", knowledge="map")
    _, infos = batch.reset(seed=4)
    single = gym.make("lidarena/Arena-v0", arena="u_trap", pick="by_seed")
    for k in range(3):
        assert np.array_equal(infos["circles"][k], single.reset(seed=4 + k)[1]["circles"])


@pytest.mark.parametrize("keywords", KEYWORDS, ids=["random", "mixed", "truth"])
def test_a_saved_batch_continues_to_the_bit_through_collisions(keywords: dict[str, Any]) -> None:
    first, second = (BatchedArena(5, max_episode_steps=70, **keywords) for _ in range(2))
    first.reset(seed=1)
    second.reset(seed=50)
    table = np.stack([actions_for(k, "action" in keywords) for k in range(5)], axis=1)
    for actions in table[:45]:
        first.step(actions)
    saved = {name: np.array(value) for name, value in first.get_state().items()}
    second.set_state(saved)
    ended = 0
    for actions in table[45:]:
        one, two = first.step(actions), second.step(actions)
        ended += int(one[2].sum())
        assert raw(one[0]) == raw(two[0]) and raw(one[1]) == raw(two[1]) and raw(one[2]) == raw(two[2])
        for name, value in first.get_state().items():
            assert np.array_equal(value, second.get_state()[name]), name
    assert ended >= 2


def test_a_state_holds_no_python_objects() -> None:
    batch = BatchedArena(2, arena="random")
    batch.reset(seed=0)
    assert all(array.dtype != object for array in batch.get_state().values())


def test_a_restored_world_of_another_arena_takes_its_obstacles_along() -> None:
    batch, other = BatchedArena(1, arena="random"), BatchedArena(1, arena="random")
    _, infos = batch.reset(seed=0)
    _, elsewhere = other.reset(seed=1)
    assert infos["circles"][0].tobytes() != elsewhere["circles"][0].tobytes()
    other.set_state(batch.get_state())
    assert other.step(np.zeros((1, 1)))[4]["circles"][0].tobytes() == infos["circles"][0].tobytes()


def test_observations_are_fresh_arrays() -> None:
    batch = BatchedArena(3, arena="yang")
    first, _ = batch.reset(seed=0)
    kept = first.copy()
    batch.step(np.zeros((3, 1)))
    assert np.array_equal(first, kept)


@pytest.mark.parametrize("count", [0, -1, 2.5])
def test_a_batch_needs_a_whole_number_of_worlds(count: Any) -> None:
    with pytest.raises(ConfigError, match="num_envs"):
        BatchedArena(count)


def test_a_batch_wants_as_many_seeds_as_worlds_and_a_reset() -> None:
    batch = BatchedArena(2)
    with pytest.raises(ResetNeeded):
        batch.step(np.zeros((2, 1)))
    with pytest.raises(ConfigError, match="3 seeds"):
        batch.reset(seed=[1, 2, 3])


@pytest.mark.parametrize("mode", ["sync", "vector_entry_point"])
def test_make_vec_works(mode: str) -> None:
    envs = gym.make_vec("lidarena/Arena-v0", num_envs=2, vectorization_mode=mode, arena="yang")
    observations, _ = envs.reset(seed=0)
    assert observations.shape == (2, 39)
    assert envs.step(np.zeros((2, 1), np.float32))[1].shape == (2,)
    envs.close()
