import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.slam.rbpf.estimator import ParticleFilterEstimator
from tests.slam.estimator_cases import settings_for, start_all


def test_the_filters_arrays_are_what_everybody_reads() -> None:
    estimator = ParticleFilterEstimator(settings_for(2), particles=4)
    start_all(estimator)
    estimator.filters.state.estimate[1] = (1.0, 2.0, 0.3)
    assert estimator.estimate[1].tolist() == [1.0, 2.0, 0.3]
    assert estimator.particles is not None and estimator.particles.shape == (2, 4, 3)


def test_equal_weights_have_the_largest_entropy() -> None:
    estimator = ParticleFilterEstimator(settings_for(1), particles=4)
    start_all(estimator)
    assert set(estimator.infos()) == {"covariance", "entropy", "n_eff", "entropy_gmapping"}
    estimator.filters.state.criteria[0, 1] = np.log(4)
    assert estimator.scaled_entropy().tolist() == [1.0]


@pytest.mark.parametrize("option", [{"particles": 0}, {"particles": 2.5}, {"resample_share": 1.5}])
def test_options_out_of_range_are_refused(option: dict[str, float]) -> None:
    with pytest.raises(ConfigError, match=next(iter(option))):
        ParticleFilterEstimator(settings_for(1), **option)


def test_what_is_saved_restores_another_one() -> None:
    one, other = (ParticleFilterEstimator(settings_for(2), particles=4) for _ in range(2))
    start_all(one)
    start_all(other)
    one.filters.state.particles[:] += 0.25
    other.load_arrays({name: array.copy() for name, array in one.arrays().items()})
    for name, array in one.arrays().items():
        assert np.array_equal(array, other.arrays()[name]), name
