"""What ``slam=`` takes, and what it refuses."""

from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError, EstimatorError, KeywordError
from lidarena.slam.dead_reckoning import DeadReckoningEstimator
from lidarena.slam.estimator import BatchEstimator, EstimatorSettings
from lidarena.slam.rbpf.estimator import ParticleFilterEstimator
from lidarena.slam.registry import BUILT_IN, check_slam, estimator_name, make_estimator
from lidarena.slam.true_pose import TruePoseEstimator
from lidarena.slam.world_estimators import WorldEstimators
from lidarena.world.lidar import LidarSpec
from lidarena.world.odometry import OdometryNoise
from tests.slam.ray_mapper import RayMapper, make_mapper

LIDAR = LidarSpec(beams=36)
ANGLES = np.arange(36) * (2 * np.pi / 36)
DIRECTIONS = np.stack([np.cos(ANGLES), np.sin(ANGLES)])
SETTINGS = EstimatorSettings(2, np.ones((1, 20, 30), np.uint8), DIRECTIONS, LIDAR, 0.05, OdometryNoise())


class Reckoner(DeadReckoningEstimator):
    """A batch of one's own."""

    def __init__(self, settings: EstimatorSettings, *, gain: float = 1.0) -> None:
        super().__init__(settings)
        self.gain = gain


@pytest.mark.parametrize(
    ("slam", "kind"),
    [
        ("rbpf", ParticleFilterEstimator),
        ("odometry", DeadReckoningEstimator),
        ("truth", TruePoseEstimator),
        ({"name": "rbpf", "particles": 3, "resample_share": 0.7}, ParticleFilterEstimator),
        (Reckoner, Reckoner),
        ({"name": Reckoner, "gain": 2.0}, Reckoner),
        ("tests.slam.test_registry:Reckoner", DeadReckoningEstimator),
        (RayMapper, WorldEstimators),
        (make_mapper, WorldEstimators),
        ("tests.slam.ray_mapper:make_mapper", WorldEstimators),
        ({"name": "tests.slam.ray_mapper:RayMapper", "drift": 0.5}, WorldEstimators),
    ],
)
def test_names_classes_and_functions_make_estimators(slam: Any, kind: type[BatchEstimator]) -> None:
    check_slam(slam)
    made = make_estimator(slam, SETTINGS)
    assert isinstance(made, kind)
    assert made.maps.occupancy.shape == (2, 20, 30) and made.estimate.shape == (2, 3)
    assert made.covariance.shape == (2, 3, 3) and made.d_optimality.shape == (2,)


def test_options_reach_the_estimator() -> None:
    filters = make_estimator({"name": "rbpf", "particles": 3, "resample_share": 0.7}, SETTINGS)
    assert isinstance(filters, ParticleFilterEstimator)
    parameters = filters.filters.parameters
    assert (parameters.particles, parameters.resample_share) == (3, 0.7)
    own = make_estimator({"name": "tests.slam.ray_mapper:RayMapper", "drift": 0.5}, SETTINGS)
    assert isinstance(own, WorldEstimators)
    assert [one.drift for one in own.each] == [0.5, 0.5]  # type: ignore[attr-defined]


def test_names_are_those_that_users_typed() -> None:
    assert estimator_name({"name": "rbpf", "particles": 3}) == estimator_name("rbpf") == "rbpf"
    assert estimator_name(RayMapper) == "RayMapper" and estimator_name("a:B") == "a:B"
    assert set(BUILT_IN) == {"rbpf", "graph", "odometry", "truth"}


@pytest.mark.parametrize(
    ("slam", "error", "told"),
    [
        (
            "rbfp",
            ConfigError,
            "slam = 'rbfp' is not known; did you mean 'rbpf'? Allowed: graph, odometry, rbpf, truth, or",
        ),
        ("no_such_module:X", ConfigError, "slam = 'no_such_module:X': there is no module 'no_such_module'"),
        ("tests.slam.ray_mapper:RayMaper", ConfigError, "has no 'RayMaper'; did you mean 'RayMapper'?"),
        (RayMapper(None), ConfigError, "must be a name, or a class or function that makes an estimator"),
        (3, ConfigError, "slam = 3 must be a name"),
        ({"particles": 3}, ConfigError, "slam = {'particles': 3} needs a 'name' beside its options"),
        ({"name": "rbpf", "partciles": 3}, KeywordError, "'partciles'; did you mean 'particles'?"),
        ({"name": "truth", "particles": 3}, KeywordError, "'truth' got an unexpected keyword argument 'particles'"),
        ({"name": RayMapper, "drfit": 3}, KeywordError, "'RayMapper' got an unexpected keyword argument 'drfit'; did"),
        (lambda: None, EstimatorError, "cannot be made by a call (lidar): too many positional arguments"),
    ],
)
def test_what_cannot_be_made_is_refused_with_the_nearest_right_one(
    slam: Any, error: type[ConfigError], told: str
) -> None:
    with pytest.raises(error) as refused:
        check_slam(slam)
    assert told in str(refused.value) and "\n" not in str(refused.value)


@pytest.mark.parametrize("option", [{"particles": 0}, {"particles": 2.5}, {"resample_share": 1.5}])
def test_options_out_of_range_are_refused(option: dict[str, Any]) -> None:
    with pytest.raises(ConfigError, match=next(iter(option))):
        make_estimator({"name": "rbpf", **option}, SETTINGS)
