import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.random_streams import normal, seed_stream, uniform
from lidarena.world.odometry import OdometryNoise, deviations, move, read_odometry, relative_motion, wrap

ANGLE = st.floats(-20, 20)
PLACE = st.floats(-50, 50)


@given(ANGLE)
def test_wrapped_angles_lie_in_the_half_open_turn_and_mean_the_same(angle: float) -> None:
    wrapped = wrap(angle)
    assert -np.pi < wrapped <= np.pi
    assert np.cos(wrapped - angle) == pytest.approx(1.0)


@settings(deadline=None)
@given(PLACE, PLACE, ANGLE, PLACE, PLACE, ANGLE)
def test_moving_by_the_relative_motion_arrives(x: float, y: float, t: float, u: float, v: float, s: float) -> None:
    before, after = np.array([x, y, wrap(t)]), np.array([u, v, wrap(s)])
    motion = relative_motion(before, after)
    move(before, *motion)
    assert before[:2] == pytest.approx(after[:2], abs=1e-9)
    assert np.cos(before[2] - after[2]) == pytest.approx(1.0)


def test_deviations_are_gmappings() -> None:
    noise = OdometryNoise(srr=0.1, srt=0.2, str_=0.3, stt=0.4)
    sx, sy, st_ = deviations(noise, 3.0, -4.0, -0.5)
    assert sx == pytest.approx(0.1 * 3 + 0.3 * 0.5 + 0.3 * 0.1 * 4)
    assert sy == pytest.approx(0.1 * 4 + 0.3 * 0.5 + 0.3 * 0.1 * 3)
    assert st_ == pytest.approx(0.4 * 0.5 + 0.2 * 5)


def test_readings_scatter_around_the_motion_as_the_model_says() -> None:
    worlds = 4000
    before = np.zeros((worlds, 1, 3))
    after = before + np.array([0.1, 0.0, 0.02])
    streams = np.stack([seed_stream(np.random.default_rng(k)) for k in range(worlds)])
    readings = np.zeros_like(before)
    read_odometry(0, worlds, before, after, OdometryNoise(), streams, readings)
    expected = deviations(OdometryNoise(), 0.1, 0.0, 0.02)
    assert readings[:, 0].mean(axis=0) == pytest.approx((0.1, 0.0, 0.02), abs=2e-3)
    assert readings[:, 0].std(axis=0) == pytest.approx(expected, rel=0.06)


def test_without_noise_the_odometry_is_exact() -> None:
    before, after = np.array([[[1.0, 2.0, 0.5]]]), np.array([[[1.2, 2.1, 0.7]]])
    readings = np.zeros_like(before)
    stream = seed_stream(np.random.default_rng(0))[None]
    read_odometry(0, 1, before, after, OdometryNoise().scaled(0.0), stream, readings)
    assert tuple(readings[0, 0]) == relative_motion(before[0, 0], after[0, 0])


def test_streams_are_standard_normal_and_uniform() -> None:
    stream = seed_stream(np.random.default_rng(3))
    draws = np.array([normal(stream) for _ in range(40000)])
    levels = np.array([uniform(stream) for _ in range(40000)])
    assert draws.mean() == pytest.approx(0, abs=0.02)
    assert draws.std() == pytest.approx(1, abs=0.015)
    assert (np.abs(draws) > 3).mean() == pytest.approx(0.0027, abs=0.0012)
    assert levels.min() >= 0
    assert levels.max() < 1
    assert np.histogram(levels, 10, (0, 1))[0].std() < 150


def test_streams_repeat_with_their_generator() -> None:
    first, second = (seed_stream(np.random.default_rng(9)) for _ in range(2))
    assert [normal(first) for _ in range(50)] == [normal(second) for _ in range(50)]
