"""Positions chained over a short flight, with every switch; steps that cannot be computed are refused."""

from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.vision.features import FeatureOptions, Features, detect
from lidarena.vision.odometry import Instruments, OdometryOptions, StereoOdometry
from lidarena.vision.rigid_motion import inverse
from tests.vision.scenes import CAMERA, motion_between, pair_at, pose_at, stream

FEATURES = FeatureOptions(kind="tracks", count=200)
PLACES = (8.0, 8.3, 8.6, 8.9, 9.2)
GUESS = motion_between(pose_at(8.0), pose_at(8.3))


def features_at(x: float, options: FeatureOptions = FEATURES) -> Features:
    return detect(pair_at(x), CAMERA, options)


def begun(**more: Any) -> StereoOdometry:
    odometry = StereoOdometry(CAMERA, OdometryOptions(features=FEATURES, **more), stream())
    odometry.begin(features_at(8.0), pose_at(8.0))
    return odometry


def off(odometry: StereoOdometry, x: float) -> float:
    return float(np.linalg.norm(odometry.pose[:3, 3] - pose_at(x)[:3, 3]))


@pytest.mark.parametrize("switches", [{}, {"clip": True}], ids=["plain", "clipped"])
def test_a_flight_is_followed(switches: dict[str, Any]) -> None:
    odometry = begun(**switches)
    for x in PLACES[1:]:
        assert odometry.advance(features_at(x), GUESS)
        assert np.allclose(odometry.pose[:3, :3] @ odometry.pose[:3, :3].T, np.eye(3), atol=1e-9)
    assert off(odometry, 9.2) < 0.02 and odometry.steps == 4 and odometry.refused == 0
    spread = np.sqrt(np.trace(odometry.covariance[:3, :3]))
    assert 1e-6 < spread < 1e-2 and odometry.effort.motions == 4 and odometry.effort.fitted > 400


@pytest.mark.parametrize("to_middle", [True, False])
def test_the_6_cloud_step_ends_in_the_middle_or_beyond(to_middle: bool) -> None:
    odometry = begun()
    guesses = GUESS, GUESS @ GUESS
    assert odometry.advance_six(features_at(8.3), features_at(8.6), guesses, to_middle=to_middle)
    assert off(odometry, 8.3 if to_middle else 8.6) < 0.015 and odometry.effort.motions == 3


def test_black_pictures_are_refused_and_the_state_is_kept() -> None:
    odometry = begun()
    odometry.advance(features_at(8.3), GUESS)
    pose, covariance = odometry.pose.copy(), odometry.covariance.copy()
    black = detect((np.zeros((400, 600), np.uint8),) * 2, CAMERA, FEATURES)
    assert not odometry.advance(black) and not odometry.advance_six(black, features_at(8.6), (None, None))
    assert np.array_equal(odometry.pose, pose) and np.array_equal(odometry.covariance, covariance)
    assert odometry.refused == 2 and odometry.steps == 1
    assert odometry.advance(features_at(8.6), GUESS) and off(odometry, 8.6) < 0.02


def test_measured_angles_take_the_place_of_those_that_were_seen() -> None:
    attitude = pose_at(8.3, heading=0.15)[:3, :3]
    replaced, fused = begun(angles="replace"), begun(angles="fuse", angle_sigma=0.001)
    for odometry in (replaced, fused):
        odometry.advance(features_at(8.3), GUESS, Instruments(attitude=attitude))
    assert np.allclose(replaced.pose[:3, :3], attitude) and not np.allclose(fused.pose[:3, :3], attitude, atol=1e-3)


def test_the_log_takes_the_place_of_what_was_seen() -> None:
    odometry = begun(velocity_log=True)
    here = inverse(pose_at(8.0)) @ pose_at(8.3)
    odometry.advance(features_at(8.3), GUESS, Instruments(displacement=here[:3, 3]))
    assert off(odometry, 8.3) < 1e-9


def test_the_depth_is_that_of_the_nearest_ground() -> None:
    assert 5.0 < begun().depth < 8.5


def test_options_that_cannot_be_are_refused() -> None:
    for change in ({"angles": "fused"}, {"least_matches": 2}, {"clip": 1}, {"angle_sigma": 0.0}):
        with pytest.raises(ConfigError, match=next(iter(change))):
            OdometryOptions(**change)  # type: ignore[arg-type]
