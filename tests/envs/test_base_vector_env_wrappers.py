"""Gymnasium's vector wrappers around the native batches do what they do around Gymnasium's own."""

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers import vector as wrappers

from tests.envs.test_base_vector_env import CASES, every_family, every_mode, native, reference, same

FLAT = [case for case in CASES if case != "map"]


def drive_both(one: gym.vector.VectorEnv, two: gym.vector.VectorEnv, steps: int = 20) -> None:
    one.action_space.seed(2)
    same(one.reset(seed=5)[0], two.reset(seed=5)[0])
    for _ in range(steps):
        actions = one.action_space.sample()
        first, second = one.step(actions), two.step(actions)
        same(first[0], second[0])
        for k in (1, 2, 3):
            assert np.allclose(first[k], second[k])
        assert one.observation_space.contains(first[0])
        if (first[2] | first[3]).any() and one.metadata["autoreset_mode"] == AutoresetMode.DISABLED:
            mask = first[2] | first[3]
            again = [envs.reset(options={"reset_mask": mask.copy()})[0] for envs in (one, two)]
            same(*again)


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.DISABLED])
@every_family
def test_flattened_observations(case: str, mode: AutoresetMode) -> None:
    one, two = native(case, autoreset_mode=mode), reference(case, mode)
    drive_both(wrappers.FlattenObservation(one), wrappers.FlattenObservation(two))


@pytest.mark.parametrize("case", FLAT)
def test_normalized_observations(case: str) -> None:
    mode = AutoresetMode.NEXT_STEP
    one, two = native(case, autoreset_mode=mode), reference(case, mode)
    drive_both(wrappers.NormalizeObservation(one), wrappers.NormalizeObservation(two))


def test_filtered_observations() -> None:
    mode = AutoresetMode.NEXT_STEP
    one, two = native("map", autoreset_mode=mode), reference("map", mode)
    drive_both(wrappers.FilterObservation(one, ["map"]), wrappers.FilterObservation(two, ["map"]))


@every_mode
@every_family
def test_episode_statistics_count_every_step_and_reward(case: str, mode: AutoresetMode) -> None:
    envs = wrappers.RecordEpisodeStatistics(native(case, autoreset_mode=mode))
    envs.action_space.seed(3)
    envs.reset(seed=0)
    returns, lengths, told, over = np.zeros(3), np.zeros(3, int), 0, np.zeros(3, bool)
    for _ in range(25):
        _, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
        returns += rewards
        lengths += ~over
        done = terminated | truncated
        for k in np.flatnonzero(done):
            assert infos["episode"]["l"][k] == lengths[k]
            assert infos["episode"]["r"][k] == pytest.approx(returns[k])
            told += 1
        returns[done], lengths[done] = 0.0, 0
        over = done & (mode == AutoresetMode.NEXT_STEP)
        if mode == AutoresetMode.DISABLED and done.any():
            envs.reset(options={"reset_mask": done})
    assert told > 6


@pytest.mark.parametrize(
    "wrap",
    [
        wrappers.NormalizeReward,
        wrappers.DictInfoToList,
        lambda envs: wrappers.ClipReward(envs, -1.0, 1.0),
        lambda envs: wrappers.RescaleAction(envs, np.float32(0.1), np.float32(0.7)),
        lambda envs: wrappers.DtypeObservation(envs, np.float32),
    ],
    ids=["NormalizeReward", "DictInfoToList", "ClipReward", "RescaleAction", "DtypeObservation"],
)
def test_other_wrappers_run(wrap: Any) -> None:
    envs = wrap(native("arena", autoreset_mode="NextStep"))
    envs.reset(seed=0)
    for k in range(12):
        envs.step(envs.action_space.high if k % 2 else envs.action_space.low)


def test_videos_of_a_batch(tmp_path: Path) -> None:
    pytest.importorskip("moviepy")
    envs = wrappers.RecordVideo(native("arena", render_mode="rgb_array", autoreset_mode="NextStep"), str(tmp_path))
    envs.reset(seed=0)
    for _ in range(12):
        envs.step(envs.action_space.sample())
    envs.close()
    assert list(tmp_path.glob("*.mp4"))
