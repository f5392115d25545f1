import numpy as np

from lidarena.slam.rbpf.particle_filter_state import FilterParameters, empty_state

PARAMETERS = FilterParameters(particles=7, history=5)


def test_arrays_are_as_large_as_worlds_particles_past_and_beams_ask_for() -> None:
    state = empty_state(3, 40, 60, 90, PARAMETERS)
    assert state.particles.shape == state.anchors.shape == (3, 7, 3)
    assert state.node_poses.shape == (3, 5, 7, 3) and state.node_scans.shape == (3, 5, 90)
    assert state.criteria.shape == (3, 4) and state.covariance.shape == (3, 3, 3)


def test_all_particles_weigh_the_same_at_first_and_continue_themselves() -> None:
    state = empty_state(2, 40, 60, 90, PARAMETERS)
    np.testing.assert_allclose(state.weights.sum(axis=1), 1.0)
    assert (state.weights == state.weights[0, 0]).all()
    assert (state.ancestors == np.arange(7)).all()


def test_worlds_share_no_memory() -> None:
    state = empty_state(2, 40, 60, 90, PARAMETERS)
    for array in (*state[1:], *state.fields):
        array[0] = 1
    rest = empty_state(2, 40, 60, 90, PARAMETERS)
    for array, untouched in zip((*state[1:], *state.fields), (*rest[1:], *rest.fields), strict=True):
        assert np.array_equal(array[1], untouched[1])
