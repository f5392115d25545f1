"""Gymnasium's wrappers and Stable-Baselines3's vectors around the single environments, from fresh processes too."""

import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import wrappers
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv

import lidarena  # noqa: F401

SINGLE: dict[str, dict[str, Any]] = {
    "lidarena/Env1-v0": {"slam": "truth"},
    "lidarena/Arena-v0": {"arena": "yang"},
    "lidarena/CorridorCentral-v0": {"robots": 2},
}
every_id = pytest.mark.parametrize("id_", SINGLE)


def drive(env: Any, steps: int = 8) -> None:
    env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(steps):
        observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation)
        if terminated or truncated:
            env.reset()
    env.close()


@pytest.mark.parametrize(
    "wrap",
    [
        partial(wrappers.TimeLimit, max_episode_steps=3),
        partial(wrappers.FrameStackObservation, stack_size=3),
        wrappers.FlattenObservation,
        wrappers.NormalizeObservation,
        wrappers.NormalizeReward,
        wrappers.RecordEpisodeStatistics,
        wrappers.TimeAwareObservation,
        wrappers.Autoreset,
    ],
    ids=lambda wrap: getattr(wrap, "func", wrap).__name__,
)
@every_id
def test_wrappers_run(id_: str, wrap: Any) -> None:
    drive(wrap(gym.make(id_, **SINGLE[id_])))


@every_id
def test_pictures_are_collected_and_observed(id_: str) -> None:
    keywords = SINGLE[id_] | {"render_mode": "rgb_array"}
    drive(wrappers.AddRenderObservation(gym.make(id_, **keywords)), 2)
    env = gym.make(id_, **keywords | {"render_mode": "rgb_array_list"})
    env.reset(seed=0)
    env.step(env.action_space.sample())
    frames: Any = env.render()
    assert len(frames) == 2 and frames[0].dtype == np.uint8


@every_id
def test_videos_are_recorded(id_: str, tmp_path: Path) -> None:
    pytest.importorskip("moviepy")
    env = gym.make(id_, render_mode="rgb_array", **SINGLE[id_])
    drive(wrappers.RecordVideo(env, str(tmp_path), episode_trigger=lambda _: True))
    assert list(tmp_path.glob("*.mp4"))


@pytest.mark.filterwarnings("ignore:Your observation  has an unconventional shape")  # of a team, a row a robot
@every_id
def test_stable_baselines_checker_finds_nothing(id_: str) -> None:
    check_env(gym.make(id_, **SINGLE[id_]), skip_render_check=True)


def make_env1(module: str = "") -> gym.Env[Any, Any]:
    return gym.make(f"{module}lidarena/Env1-v0", slam="truth")


def test_stable_baselines_vectors_agree_with_the_native_batch() -> None:
    batch = gym.make_vec("lidarena/Env1-v0", 2, "vector_entry_point", slam="truth")
    expected, _ = batch.reset(seed=4)
    vector = DummyVecEnv([make_env1] * 2)
    vector.seed(4)
    assert np.array_equal(vector.reset(), expected)
    vector.close()


_BARE = """
import functools
import gymnasium as gym
from stable_baselines3.common.vec_env import SubprocVecEnv

if __name__ == "__main__":
    make = functools.partial(gym.make, "lidarena:lidarena/Env1-v0", slam="truth")
    vector = SubprocVecEnv([make] * 2, start_method="spawn")
    vector.seed(4)
    print(vector.reset().shape)
    print(gym.make("lidarena:lidarena/Arena-v0").spec.id)
    vector.close()
"""


def test_a_process_that_never_imported_the_package_names_the_module_too(tmp_path: Path) -> None:
    """Its workers are spawned: nothing is imported there but what they are told."""
    script = tmp_path / "bare.py"
    script.write_text(_BARE)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=300, env=_on_path())
    assert done.stdout.split("\n")[:2] == ["(2, 7)", "lidarena/Arena-v0"], done.stderr


def _on_path() -> dict[str, str]:
    import os

    return os.environ | {"PYTHONPATH": os.pathsep.join([os.getcwd(), *sys.path])}


def test_without_the_module_gymnasium_knows_no_such_namespace(tmp_path: Path) -> None:
    code = "import gymnasium as gym; gym.make('lidarena/Env1-v0')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, env=_on_path())
    assert "NamespaceNotFound" in done.stderr


def test_workers_that_are_spawned_from_here_take_the_module_too() -> None:
    vector = SubprocVecEnv([partial(make_env1, "lidarena:")] * 2, start_method="spawn")
    try:
        vector.seed(4)
        batch = gym.make_vec("lidarena/Env1-v0", 2, "vector_entry_point", slam="truth")
        assert np.array_equal(vector.reset(), batch.reset(seed=4)[0])
    finally:
        vector.close()
