"""Dead reckoning: the pose is what the odometry adds up to, and the covariance says how wrong that is."""

import numpy as np
import pytest

from lidarena.envs import BatchedExploration, ExplorationEnv
from lidarena.slam.uncertainty import COVARIANCE_FLOOR, d_optimality
from lidarena.world.floorplan import Floorplan

WALLS = [(0, 0, 20, 0), (20, 0, 20, 20), (20, 20, 0, 20), (0, 20, 0, 0)]
HALL = Floorplan.from_shapes("hall", (0, 0, 20, 20), walls=WALLS, start=(10.0, 10.0, 0.5))
"""So large that nobody meets a wall."""


def driven(worlds: int, steps: int, odometry_noise: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """Errors of the pose (worlds, 3) and their covariances (worlds, 3, 3) after the same drive in many worlds."""
    batch = BatchedExploration(
        worlds, map=HALL, slam="odometry", odometry_noise=odometry_noise, stop_at=None, expose_truth=True
    )
    batch.reset(seed=0)
    for k in range(steps):
        infos = batch.step(np.full(worlds, (0, 0, 1, 0, 2, 1)[k % 6]))[4]
    error = infos["pose"] - infos["truth"]["pose"]
    error[:, 2] = (error[:, 2] + np.pi) % (2 * np.pi) - np.pi
    return error, infos["covariance"]


def test_the_pose_is_the_odometry_added_up_and_the_map_is_traced_from_there() -> None:
    env = ExplorationEnv(map="env1", slam="odometry")
    _, info = env.reset(seed=0)
    for action in [0, 0, 1, 1, 0, 2, 0]:
        assert np.array_equal(info["pose"], info["odometry_pose"])
        assert info["d_optimality"] == d_optimality(info["covariance"])
        *_, info = env.step(action)
    assert (info["map"] == 0).sum() > 500 and (info["map"] == 100).sum() > 50


def test_errors_are_as_large_as_the_covariance_says() -> None:
    error, covariance = driven(400, 40)
    normalised = np.einsum("wi,wij,wj->w", error, np.linalg.inv(covariance), error)
    # Three degrees of freedom; the mean of 400 scatters by 0.12. It is somewhat cautious, as the deviations are those
    # of what was measured, which is mostly longer than the true motion.
    assert 2.0 < normalised.mean() < 3.3
    assert np.quantile(normalised, 0.95) == pytest.approx(7.0, abs=1.5)


def test_certainty_is_only_ever_lost_and_more_of_it_with_more_noise() -> None:
    volumes = []
    for noise in (0.5, 1.0, 2.0):
        spread = driven(2, 12, noise)[1][0]
        assert np.allclose(spread, spread.T, atol=1e-15) and np.linalg.eigvalsh(spread).min() >= min(COVARIANCE_FLOOR)
        volumes.append(d_optimality(spread))
    assert volumes[0] < volumes[1] < volumes[2]
    env = ExplorationEnv(map=HALL, slam="odometry")
    _, info = env.reset(seed=0)
    assert np.array_equal(info["covariance"], np.diag(COVARIANCE_FLOOR))
    before = info["d_optimality"]
    for _ in range(10):
        *_, info = env.step(0)
        assert info["d_optimality"] > before
        before = info["d_optimality"]


def test_a_new_episode_begins_as_certain_as_the_first() -> None:
    env = ExplorationEnv(map="env1", slam="odometry")
    beginnings = []
    for _ in range(2):
        _, info = env.reset(seed=3)
        beginnings.append((info["pose"].tobytes(), info["covariance"].tobytes(), info["map"].tobytes()))
        for _ in range(5):
            env.step(0)
    assert beginnings[0] == beginnings[1]
