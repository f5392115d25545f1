"""What a policy sees is named, within its bounds, and tells what happened."""

import numpy as np

from lidarena.envs.seabed.observations import LARGEST, NAMES, observe
from tests.envs.seabed.short_flights import made


def test_numbers_tell_of_the_last_step() -> None:
    env = made()
    env.reset(seed=0)
    before = dict(zip(NAMES, observe(env.unwrapped.episodes.vehicles[0]).tolist(), strict=True))
    seen = env.step(np.array([2, 0]))[0]
    after = dict(zip(NAMES, seen.tolist(), strict=True))
    assert seen.dtype == np.float32 and (seen >= 0).all() and (seen <= LARGEST).all()
    left = "frames left / 96, at most 1"
    assert before[left] == 1.0 and np.isclose(after[left], 80 / 96)
    assert before["last skip / 64"] == 0.0 and after["last skip / 64"] == 20 / 64
    assert 0.3 < after["nearest ground / 10 m"] < 0.75 and after["last step refused"] == 0.0
    assert 0.5 < after["matches over features"] <= 1.0 and 0.2 < after["speed [m/s]"] < 0.8
