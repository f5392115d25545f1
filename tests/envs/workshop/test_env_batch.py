"""The batch of workshops and the single one agree to the bit, and a saved batch goes on to the bit."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import lidarena  # noqa: F401
from lidarena.envs.workshop.env import BatchedWorkshop
from tests.envs import batch_runs
from tests.envs.batch_runs import raw
from tests.envs.workshop.workshops import loose

STEPS = 40
KEYWORDS: list[dict[str, Any]] = [
    {"task": "gearbox", "human": "mixture"},
    {"task": loose(4), "human": "free", "separation": 0.0, "expose_truth": True, "recognition": "position"},
]


def actions_for(world: int, count: int) -> np.ndarray:
    return np.random.default_rng(100 + world).integers(0, count, STEPS)


@pytest.mark.parametrize("keywords", KEYWORDS, ids=["gearbox", "touching"])
def test_world_i_of_any_batch_equals_the_single_environment_with_its_seed(keywords: dict[str, Any]) -> None:
    count = gym.make("lidarena/Workshop-v0", **keywords).action_space.n
    singles = {}
    for seed in (0, 2, 9):
        env = gym.make("lidarena/Workshop-v0", max_episode_steps=30, **keywords)
        singles[seed] = batch_runs.alone(env, actions_for(seed, count), seed)[0]
    for size in (1, 3, 16):
        batch = gym.make_vec("lidarena/Workshop-v0", size, "vector_entry_point", max_episode_steps=30, **keywords)
        records = batch_runs.together(batch, np.stack([actions_for(k, count) for k in range(size)], axis=1))
        for seed, expected in singles.items():
            if seed < size:
                assert records[seed] == expected


@pytest.mark.parametrize("keywords", KEYWORDS, ids=["gearbox", "touching"])
def test_a_saved_batch_continues_to_the_bit(keywords: dict[str, Any]) -> None:
    first, second = (BatchedWorkshop(4, **keywords) for _ in range(2))
    first.reset(seed=1)
    second.reset(seed=2)
    rng = np.random.default_rng(0)
    for k in range(30):
        masks = first.action_masks()
        actions = (rng.random(masks.shape) * masks).argmax(axis=1)
        if k == 12:
            second.set_state(first.get_state())
        outcome = first.step(actions)
        if k >= 12:
            again = second.step(actions)
            assert raw(outcome[0]) == raw(again[0]) and raw(outcome[1:4]) == raw(again[1:4])


def test_masks_of_a_batch_are_those_of_its_worlds() -> None:
    batch = BatchedWorkshop(3, task="gearbox")
    _, infos = batch.reset(seed=0)
    assert batch.action_masks().shape == (3, 11) and np.array_equal(batch.action_masks(), infos["action_mask"])
    assert batch.task.name == "gearbox" and batch.episodes.restorable
