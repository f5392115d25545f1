"""The fixed step is fixed, until there is no way on."""

import numpy as np
import pytest

from lidarena import baselines
from lidarena.base.errors import ConfigError
from tests.envs.seabed.short_flights import made


def test_it_skips_the_same_and_halves_after_a_refusal() -> None:
    policy = baselines.make("fixed_step", made(), frames=12, mode="six_clouds")
    policy.reset(seed=0)
    assert policy.act(None, {"refused": False, "skip": 3}).tolist() == [1, 1]
    assert policy.act(None, {"refused": True, "skip": 10}).tolist() == [0, 1]
    assert policy.act(None, {"refused": False, "skip": 5}).tolist() == [1, 1]


def test_it_flies() -> None:
    env = made(expose_truth=True)
    policy = baselines.make("fixed_step", env, frames=10)
    observation, info = env.reset(seed=0)
    while not info["success"]:
        observation, _, _, _, info = env.step(policy.act(observation, info))
    assert info["positions"] == 10 and info["truth"]["error"] < 0.03


@pytest.mark.parametrize(("options", "words"), [({"frames": 0}, "frames = 0"), ({"mode": "six"}, "mode = 'six'")])
def test_options_are_checked(options: dict[str, object], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        baselines.make("fixed_step", made(), **options)
    assert np.array_equal(baselines.make("fixed_step", made()).act(None, {"refused": False, "skip": 0}), [0, 0])
