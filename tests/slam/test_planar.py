import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lidarena.slam.planar import between, compose, inverse, wrapped

poses = st.lists(st.floats(-50, 50), min_size=3, max_size=3).map(np.array)


def same(a: np.ndarray, b: np.ndarray) -> None:
    np.testing.assert_allclose(a[..., :2], b[..., :2], atol=1e-9)
    np.testing.assert_allclose(np.cos(a[..., 2] - b[..., 2]), 1.0, atol=1e-12)


@given(poses, poses)
def test_between_undoes_compose(a: np.ndarray, b: np.ndarray) -> None:
    same(compose(a, between(a, b)), b)
    same(between(a, compose(a, b)), b)


@given(poses, poses)
def test_the_way_back_leads_back(a: np.ndarray, motion: np.ndarray) -> None:
    same(compose(compose(a, motion), inverse(motion)), a)


@given(st.floats(-1e3, 1e3))
def test_angles_are_wrapped_into_one_turn(angle: float) -> None:
    turned = wrapped(np.array([angle]))[0]
    assert -np.pi < turned <= np.pi + 1e-12
    assert abs(np.exp(1j * turned) - np.exp(1j * angle)) < 1e-9
