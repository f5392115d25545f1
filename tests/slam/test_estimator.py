"""What every estimator has."""

import numpy as np
import pytest

from lidarena.slam.dead_reckoning import DeadReckoningEstimator
from lidarena.slam.estimator import BatchEstimator, map_arrays
from lidarena.slam.rbpf.estimator import ParticleFilterEstimator
from lidarena.slam.true_pose import TruePoseEstimator
from tests.slam.estimator_cases import settings_for, start_all

KINDS = [DeadReckoningEstimator, ParticleFilterEstimator, TruePoseEstimator]


@pytest.mark.parametrize("kind", KINDS)
def test_an_episode_begins_with_the_pose_and_an_unknown_map(kind: type[BatchEstimator]) -> None:
    estimator = kind(settings_for(3))
    start_all(estimator)
    believed = estimator.estimate if estimator.particles is None else estimator.particles.mean(axis=1)
    np.testing.assert_allclose(believed, [[0.0, 0.0, 0.2]] * 3, atol=1e-12)
    assert (estimator.maps.occupancy == -1).all()


@pytest.mark.parametrize("kind", KINDS)
def test_worlds_begin_apart(kind: type[BatchEstimator]) -> None:
    estimator = kind(settings_for(2))
    start_all(estimator)
    before = {name: array.copy() for name, array in estimator.arrays().items() if array.shape[:1] == (2,)}
    estimator.start(1, 0, np.zeros(2), np.array([1.0, 0.5, 0.0]), np.random.default_rng(5))
    believed = estimator.estimate[1] if estimator.particles is None else estimator.particles[1].mean(axis=0)
    assert believed.tolist() == pytest.approx([1.0, 0.5, 0.0])
    assert all(np.array_equal(estimator.arrays()[name][0], array[0]) for name, array in before.items())


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_saved_restores_another_batch(kind: type[BatchEstimator]) -> None:
    one, other = kind(settings_for(2)), kind(settings_for(2))
    start_all(one)
    start_all(other)
    one.maps.occupancy[0, 3:5] = 100
    one.estimate[1, 0] = 7.0
    other.load_arrays({name: array.copy() for name, array in one.arrays().items()})
    for name, array in one.arrays().items():
        assert np.array_equal(array, other.arrays()[name]), name


def test_an_abstract_batch_cannot_be_made() -> None:
    with pytest.raises(TypeError, match="sense_and_estimate"):
        BatchEstimator(settings_for(1))  # type: ignore[abstract]


def test_of_a_map_everything_is_saved_but_what_is_wanted() -> None:
    estimator = TruePoseEstimator(settings_for(1))
    names = set(map_arrays(estimator.maps))
    assert "maps.occupancy" in names and "maps.wanted" not in names
