"""Episodes end where the flight does or after so many decisions, and an observer of one's own is asked."""

from typing import Any

import gymnasium as gym
import numpy as np

from lidarena.envs.seabed.episodes import SeabedEpisodes
from lidarena.envs.seabed.options import SeabedOptions
from tests.envs.seabed.short_flights import SHORT


class Heights:
    space = gym.spaces.Box(0.0, 100.0, (1,), np.float32)

    def observe(self, info: dict[str, Any]) -> np.ndarray:
        assert "truth" not in info
        return np.array([info["height"]], np.float32)


def test_decisions_run_out() -> None:
    episodes = SeabedEpisodes(2, SeabedOptions.checked(SHORT | {"max_episode_steps": 2}))
    episodes.reset([0, 1], [np.random.default_rng(0), np.random.default_rng(1)])
    for last in (False, True):
        _, terminated, truncated = episodes.step([[2, 0], [1, 0]])
        assert not terminated.any() and truncated.tolist() == [last, last]
    assert episodes.infos()["frame"].tolist() == [40, 20]


def test_an_observer_of_ones_own_is_asked() -> None:
    options = SeabedOptions.checked(SHORT | {"observation": Heights(), "expose_truth": True})
    episodes = SeabedEpisodes(1, options)
    episodes.reset([0], [np.random.default_rng(0)])
    assert episodes.single_observation_space is Heights.space and 3.0 < episodes.observe()[0, 0] < 7.5


def test_it_goes_on_from_its_arrays() -> None:
    one, two = (SeabedEpisodes(1, SeabedOptions.checked(SHORT)) for _ in range(2))
    for episodes in (one, two):
        episodes.reset([0], [np.random.default_rng(3)])
    one.step([[1, 0]])
    two.load_arrays({name: array.copy() for name, array in one.arrays().items()})
    assert one.step([[2, 1]])[0] == two.step([[2, 1]])[0]
