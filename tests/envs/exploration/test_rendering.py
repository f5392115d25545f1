import gymnasium as gym
import numpy as np

import lidarena  # noqa: F401
from lidarena.envs.exploration.rendering import path_points


def drawn(steps: int, **keywords: object) -> tuple[gym.Env, np.ndarray]:
    env = gym.make("lidarena/Env1-v0", render_mode="rgb_array", **keywords)
    env.reset(seed=0)
    for _ in range(steps):
        env.step(0)
    return env, env.render()


def test_truth_and_belief_stand_side_by_side() -> None:
    _, picture = drawn(5)
    assert picture.dtype == np.uint8 and picture.ndim == 3
    half = picture.shape[1] // 2
    assert (picture[:, :half] < 250).any() and (picture[:, half:] < 250).any()


def test_the_picture_changes_with_every_step_and_repeats_with_the_seed() -> None:
    _, early = drawn(2)
    _, late = drawn(6)
    _, again = drawn(6)
    assert (early != late).any() and (late == again).all()


def test_paths_are_true_believed_and_by_the_wheels() -> None:
    env, _ = drawn(6, odometry_noise=3.0)
    core = env.unwrapped.episodes.core
    true, believed, by_wheels = path_points(core)[0]
    assert true.tolist() == core.physics.poses[0, 0, :2].tolist()
    assert believed.tolist() == core.estimate[0, :2].tolist()
    assert not np.array_equal(true, by_wheels)


def test_every_slam_can_be_drawn() -> None:
    for slam in ("truth", "odometry", "rbpf"):
        assert drawn(3, slam=slam)[1].size
