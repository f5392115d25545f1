"""With the true pose nothing is in doubt."""

import numpy as np

from lidarena.envs import ExplorationEnv
from lidarena.slam.true_pose import TruePoseEstimator
from lidarena.slam.uncertainty import COVARIANCE_FLOOR
from tests.slam.estimator_cases import settings_for


def test_the_believed_pose_is_the_true_one_however_the_wheels_slip() -> None:
    env = ExplorationEnv(map="env1", slam="truth", odometry_noise=5.0, expose_truth=True)
    env.reset(seed=0)
    for action in (0, 0, 1, 0, 2, 0):
        info = env.step(action)[4]
        np.testing.assert_array_equal(info["pose"], info["truth"]["pose"])


def test_the_pose_is_as_certain_as_poses_get() -> None:
    estimator = TruePoseEstimator(settings_for(2))
    np.testing.assert_array_equal(estimator.covariance[1], np.diag(COVARIANCE_FLOOR))
    assert estimator.scaled_entropy().tolist() == [0.0, 0.0]


def test_walls_are_mapped_where_they_are() -> None:
    env = ExplorationEnv(map="env1", slam="truth")
    _, info = env.reset(seed=0)
    for _ in range(6):
        info = env.step(0)[4]
    occupied = np.argwhere(info["map"] >= 65)
    assert len(occupied) > 20
    points = info["origin"] + (occupied[:, ::-1] + 0.5) * 0.05
    plan = env.unwrapped.episodes.core.plans[0]
    raster = plan.raster(0.05)
    cells = np.floor((points - raster.origin) / 0.05).astype(int)
    inside = (
        (cells >= 0).all(axis=1) & (cells[:, 1] < raster.clearance.shape[0]) & (cells[:, 0] < raster.clearance.shape[1])
    )
    assert np.median(raster.clearance[cells[inside, 1], cells[inside, 0]]) < 0.05
