"""The world in which the combined agent learns: every step chooses where to explore next, and the driver gets there."""

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.utils import seeding
from numpy.typing import NDArray

from lidarena.base.generator_state import generator_from_words, generator_words
from lidarena.baselines.exploration.frontier_features import CANDIDATES, FEATURES
from lidarena.baselines.exploration.goal_choice import GoalChoicePolicy

GOAL_CHOICE_ID = "lidarena/GoalChoice-v0"
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

    The exploration world's, ``reward="combined"``, summed over the decision periods of the step; what it earns before
    the first choice is nobody's merit and left out.

    ## Episode end

    As in the exploration world; also when no frontier is left, or nothing new has come for three minutes.

    ## Arguments

    Those of ``lidarena/Exploration-v0``; ``reward`` is ``"combined"`` unless given.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - as gym.Env declares it

    def __init__(self, **keywords: Any) -> None:
        """Make the world.

        Raises:
            ConfigError: A keyword that the exploration world refuses.
        """
        keywords = {"reward": "combined"} | keywords
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
                self._there = features[:, 0] > 0.5
                return features, self._info()

    def _begin(self) -> tuple[NDArray[np.float32], float, bool, bool]:
        """Begin an episode of the exploration world, and write down what it takes to begin it again."""
        self._began_with = generator_words(self._world.unwrapped.np_random)
        self._choices: list[int] = []
        self._seen = self._world.reset()
        self._policy.reset()
        self._choice = None
        return self._drive()

    def step(self, action: int) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Drive to a candidate until the next choice is due."""
        self._choice = int(action)
        self._choices.append(int(action))
        features, reward, terminated, truncated = self._drive()
        self._there = features[:, 0] > 0.5
        return features, reward, terminated, truncated, self._info()

    def action_masks(self) -> NDArray[np.bool_]:
        """Which candidates are there (CANDIDATES,), as sb3-contrib's MaskablePPO asks for it."""
        return self._there

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
            observation, gain, terminated, truncated, info = self._world.step(action)
            self._seen = observation, info
            reward += float(gain)
            if terminated or truncated:
                return nothing, reward, terminated, truncated

    def _info(self) -> dict[str, Any]:
        info = self._seen[1]
        return {name: float(info[name]) for name in ("completeness", "collision", "path_length", "time")}

    def close(self) -> None:
        """Close the world."""
        self._world.close()
