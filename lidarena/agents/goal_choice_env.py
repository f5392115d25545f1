"""The world in which the combined agent learns: every step chooses where to explore next, and the driver gets there."""

import math
from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.utils import seeding
from numpy.typing import NDArray

from lidarena.baselines.frontier_features import CANDIDATES, FEATURES
from lidarena.baselines.goal_choice import GoalChoicePolicy
from lidarena.envs.generator_state import generator_from_words, generator_words
from lidarena.world.refusals import ConfigError

GOAL_CHOICE_ID = "lidarena/GoalChoice-v0"
_WEIGHTS = {"path": 1.0, "uncertainty": 2.7, "coverage": 5.0, "collision": 3.0}
_PATH_PER_AREA = 0.55
"""About what ``frontier`` drives for a square metre of floor plan [1/m]; paths are weighed against it."""
_ORDINARY_PATH = 31.0
"""Certainty is weighed as given in a world of this usual path [m], and by the ratio's power 1.5 more in larger ones, in
which it is lost sooner."""
_USUAL, _USUAL_STEPS = 1.3e-4, 50
"""The mean of D-optimality begins as if it had been this for so many steps; the certain start says little."""
_LARGEST = 30.0


class _ChoiceNeeded(Exception):  # noqa: N818  not an error: it carries the question out of the policy
    def __init__(self, features: NDArray[np.float32]) -> None:
        self.features = features


class GoalChoiceEnv(gym.Env[NDArray[np.float32], Any]):
    """Choose where to explore next.

    ## Description

    An exploration world (``lidarena/Exploration-v0``) in which a robot drives as ``GoalChoicePolicy`` does. A step
    lasts until the next choice is due.

    ## Action space

    ``Discrete(CANDIDATES)``: which candidate to go to; one that is not there stands for the nearest.

    ## Observation space

    ``Box(-30, 30, (CANDIDATES, FEATURES), float32)``: see ``frontier_features.NAMES``.

    ## Rewards

    Sums over the decision periods of the step: coverage · Δcompleteness - path · Δpath / (0.55/m · area of the floor
    plan) - uncertainty · (area / 56 m²)^1.5 · Δ(mean of ln D since the start), and - collision at a collision. Over an
    episode this adds up to what a comparison measures. The weights are the keyword ``weights``.

    ## Episode end

    As in the exploration world; also when no frontier is left.

    ## Arguments

    ``weights``: overrides by name; all others are those of ``lidarena/Exploration-v0``.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - as gym.Env declares it

    def __init__(self, weights: Mapping[str, float] | None = None, **keywords: Any) -> None:
        """Make the world.

        Raises:
            ConfigError: An unknown weight, or a keyword that the exploration world refuses.
        """
        for name in weights or {}:
            if name not in _WEIGHTS:
                raise ConfigError(f"unknown weight {name!r}, allowed are {', '.join(_WEIGHTS)}")
        self._weights = _WEIGHTS | dict(weights or {})
        self._world: gym.Env[Any, Any] = gym.make("lidarena/Exploration-v0", disable_env_checker=True, **keywords)
        self._policy = GoalChoicePolicy(self._world, self._answer)
        self._choice: int | None = None
        self.observation_space = gym.spaces.Box(-_LARGEST, _LARGEST, (CANDIDATES, FEATURES), np.float32)
        self.action_space = gym.spaces.Discrete(CANDIDATES)

    def _answer(self, features: NDArray[np.float32]) -> int:
        """What the policy asks: the action of the step, or, where it is used up, the end of the step."""
        if self._choice is None:
            raise _ChoiceNeeded(features)
        choice, self._choice = self._choice, None
        return choice

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an episode, up to its first choice."""
        super().reset(seed=seed)
        if seed is not None:
            self._world.unwrapped.np_random = seeding.np_random(seed)[0]
        while True:
            features, _, terminated, truncated = self._begin()
            if not (terminated or truncated):  # a world without a single choice teaches nothing
                return features, self._info()

    def _begin(self) -> tuple[NDArray[np.float32], float, bool, bool]:
        """Begin an episode of the exploration world, and write down what it takes to begin it again."""
        self._began_with = generator_words(self._world.unwrapped.np_random)
        self._choices: list[int] = []
        self._seen = self._world.reset()
        x_min, y_min, x_max, y_max = self._world.get_wrapper_attr("floorplan").bounds
        self._usual_path = _PATH_PER_AREA * (x_max - x_min) * (y_max - y_min)
        self._size = self._usual_path / _ORDINARY_PATH
        self._log_mean, self._steps = math.log(_USUAL), 0
        self._policy.reset()
        self._choice = None
        return self._drive()

    def step(self, action: int) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Drive to a candidate until the next choice is due."""
        self._choice = int(action)
        self._choices.append(int(action))
        features, reward, terminated, truncated = self._drive()
        return features, reward, terminated, truncated, self._info()

    @property
    def memory(self) -> tuple[NDArray[np.uint64], NDArray[np.int64]]:
        """How the episode came about: the generator's words (6,) at its beginning, and the choices since then.

        Setting it lives through the same episode again, up to the same moment.
        """
        return self._began_with, np.array(self._choices, dtype=np.int64)

    @memory.setter
    def memory(self, memory: tuple[NDArray[np.uint64], NDArray[np.int64]]) -> None:
        words, choices = memory
        self._world.unwrapped.np_random = generator_from_words(words)
        self._begin()
        for choice in choices.tolist():
            self.step(choice)

    def _drive(self) -> tuple[NDArray[np.float32], float, bool, bool]:
        """Let the policy drive until it asks, or the episode ends."""
        reward, nothing = 0.0, np.zeros((CANDIDATES, FEATURES), np.float32)
        while True:
            try:
                action = self._policy.act(*self._seen)
            except _ChoiceNeeded as needed:
                return np.clip(needed.features, -_LARGEST, _LARGEST), reward, False, False
            if self._policy.finished:
                return nothing, reward, True, False
            before = self._seen[1]
            observation, _, terminated, truncated, info = self._world.step(action)
            self._seen = observation, info
            reward += self._gain(before, info)
            if terminated or truncated:
                return nothing, reward, terminated, truncated

    def _gain(self, before: Mapping[str, Any], info: Mapping[str, Any]) -> float:
        weights, mean = self._weights, self._log_mean
        self._steps += 1
        self._log_mean += (math.log(info["d_optimality"]) - mean) / (self._steps + _USUAL_STEPS)
        return float(
            weights["coverage"] * (info["completeness"] - before["completeness"])
            - weights["path"] * (info["path_length"] - before["path_length"]) / self._usual_path
            - weights["uncertainty"] * self._size**1.5 * (self._log_mean - mean)
            - weights["collision"] * info["collision"]
        )

    def _info(self) -> dict[str, Any]:
        info = self._seen[1]
        return {name: float(info[name]) for name in ("completeness", "collision", "path_length", "time")}

    def close(self) -> None:
        """Close the world."""
        self._world.close()


def register_goal_choice() -> None:
    """Register the id; doing so again changes nothing."""
    if GOAL_CHOICE_ID not in gym.registry:
        gym.register(
            id=GOAL_CHOICE_ID,
            entry_point="lidarena.agents.goal_choice_env:GoalChoiceEnv",
            vector_entry_point="lidarena.agents.goal_choice_batch:GoalChoiceBatch",
        )
