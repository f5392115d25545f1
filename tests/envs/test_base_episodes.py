"""A family of the smallest kind: what is counted, announced, told and cut off without it saying so."""

from types import SimpleNamespace
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.envs.base_env import SingleWorld
from lidarena.envs.base_episodes import OneAgentEpisodes
from lidarena.envs.episodes import Outcome
from lidarena.envs.infos import Info
from lidarena.envs.rewards import RewardTerms, choose_reward

TERMS = RewardTerms(("drawn",), {"default": {"drawn": 1.0}})


class Dice(OneAgentEpisodes):
    """Every world throws a die when it begins, and shows it."""

    def __init__(self, worlds: int, limit: int = -1, observation: Any = "number") -> None:
        options = SimpleNamespace(max_episode_steps=limit, observation=observation, render_mode=None)
        super().__init__(worlds, options, choose_reward("default", TERMS), gym.spaces.Discrete(2))
        self._choose_observation(("number", "half"), lambda name: gym.spaces.Box(0, 6 if name == "number" else 3, (1,)))
        self.numbers, self.seeds = np.zeros(worlds), [-1] * worlds
        self.completed: list[list[int]] = []

    def _begin(self, world: int, rng: np.random.Generator, seed: int | None) -> None:
        self.numbers[world], self.seeds[world] = rng.integers(1, 7), -1 if seed is None else seed

    def _complete_reset(self, worlds: list[int]) -> None:
        self.completed.append(worlds)

    def _facts(self) -> Info:
        return Info(number=self.numbers.copy())

    def _look(self) -> NDArray[np.float32]:
        return self.numbers[:, None].astype(np.float32)

    def step(self, actions: Any) -> Outcome:
        self._note_step()
        rewards = self._rewards.add_up({"drawn": self.numbers}, np.asarray(actions))
        return rewards, np.zeros(self.worlds, np.bool_), self._out_of_steps()

    def picture(self, world: int) -> None:
        return None

    def arrays(self) -> dict[str, NDArray[Any]]:
        return {"numbers": self.numbers}

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        self.numbers[:] = saved["numbers"]


class Double:
    """Observes twice the number."""

    space = gym.spaces.Box(0.0, 12.0, (1,), np.float32)

    def observe(self, info: Info) -> NDArray[np.float32]:
        return np.array([2 * info["number"]], np.float32)


def generators(count: int) -> list[np.random.Generator]:
    return [np.random.default_rng(one) for one in range(count)]


def test_only_the_worlds_that_are_reset_begin_with_their_own_seeds() -> None:
    dice = Dice(3)
    dice.reset([0, 1, 2], generators(3), [5, None, 7])
    assert dice.seeds == [5, -1, 7] and dice.completed == [[0, 1, 2]]
    before = dice.numbers.copy()
    dice.reset([1], [*generators(1), np.random.default_rng(9), *generators(1)])
    assert dice.numbers[[0, 2]].tolist() == before[[0, 2]].tolist() and dice.seeds == [5, -1, 7]


def test_steps_are_counted_a_world_and_cut_off_at_the_limit() -> None:
    dice = Dice(2, limit=2)
    dice.reset([0, 1], generators(2))
    assert dice.step([0, 0])[2].tolist() == [False, False]
    dice.reset([0], generators(2))
    assert dice.step([0, 0])[2].tolist() == [False, True]
    endless = Dice(1)
    endless.reset([0], generators(1))
    assert not any(endless.step([0])[2][0] for _ in range(50))


def test_what_is_told_holds_what_the_step_was_worth() -> None:
    dice = Dice(2)
    dice.reset([0, 1], generators(2))
    rewards, *_ = dice.step([0, 0])
    told = dice.infos()
    assert rewards.tolist() == told["number"].tolist() == told["reward_terms"]["drawn"].tolist()
    told["number"][:] = 0
    assert dice.last_infos()["number"].tolist() == rewards.tolist()


def test_an_observer_of_ones_own_takes_the_familys_place() -> None:
    dice = Dice(2, observation=Double())
    dice.reset([0, 1], generators(2))
    assert dice.single_observation_space is Double.space
    assert dice.observe()[:, 0].tolist() == (2 * dice.numbers).tolist()
    with pytest.raises(ConfigError, match="'nubmer' is not known; did you mean 'number'"):
        Dice(1, observation="nubmer")


def test_it_is_an_environment_as_it_stands() -> None:
    env = SingleWorld(Dice(1, limit=3, observation="half"))
    assert env.observation_space.high.tolist() == [3]
    env.reset(seed=3)
    assert [env.step(0)[3] for _ in range(3)] == [False, False, True]
