"""A batch of tiny worlds with the manners of the real one; `tests.agents.fake_batch:fakebatch/Line-v0` registers it.

A robot on the line [0, 1] should reach the right end without touching the left one. The batch is as nasty as may
be: it writes every observation and reward into the same buffers.
"""

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, suggest

KEYWORDS = {
    "reward": "completeness",
    "observation": "line",
    "action": "discrete",
    "max_episode_steps": 20,
    "noise": 0.02,
}


def single_observation_space(observation: str) -> spaces.Space[Any]:
    if observation == "line":
        return spaces.Box(0, 1, (3,), np.float32)
    return spaces.Dict(
        {"map": spaces.Box(0, 255, (1, 36, 36), np.uint8), "state": spaces.Box(-np.inf, np.inf, (3,), np.float32)}
    )


class LineBatch(VectorEnv[Any, Any, Any]):
    """Actions: 0 stay, 1 right, 2 left by 0.1; or a number in [-1, 1] times 0.1."""

    metadata = {"autoreset_mode": AutoresetMode.SAME_STEP, "render_modes": ["rgb_array"]}  # noqa: RUF012

    def __init__(self, num_envs: int = 1, render_mode: str | None = None, **keywords: Any) -> None:
        for key in keywords.keys() - KEYWORDS.keys():
            raise ConfigError(f"there is no keyword {key!r}{suggest(key, KEYWORDS)}")
        self.keywords = {**KEYWORDS, **keywords}
        self.num_envs, self.render_mode = num_envs, render_mode
        self.single_observation_space = single_observation_space(self.keywords["observation"])
        discrete = self.keywords["action"] == "discrete"
        self.single_action_space = spaces.Discrete(3) if discrete else spaces.Box(-1, 1, (1,), np.float32)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.position, self.previous = np.zeros(num_envs), np.zeros(num_envs)
        self.age = np.zeros(num_envs, dtype=np.int64)
        self.generators = [np.random.default_rng() for _ in range(num_envs)]
        self._line = np.zeros((num_envs, 3), dtype=np.float32)
        self._rewards = np.zeros(num_envs)
        self.difficulty = 1

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        if seed is not None:
            self.generators = [np.random.default_rng(seed + world) for world in range(self.num_envs)]
        self._restart(np.arange(self.num_envs))
        everywhere = np.ones(self.num_envs, dtype=bool)
        return self._observe(), {"completeness": self.position.copy(), "_completeness": everywhere}

    def step(self, actions: Any) -> tuple[Any, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        actions = np.asarray(actions)
        discrete = isinstance(self.single_action_space, spaces.Discrete)
        moves = np.array([0.0, 0.1, -0.1])[actions] if discrete else 0.1 * actions[:, 0]
        noise = np.array([generator.normal(0, self.keywords["noise"]) for generator in self.generators])
        before = self.position.copy()
        self.position = np.clip(self.position + moves + noise, 0, 1)
        self.previous = np.asarray(actions, dtype=np.float64).reshape(self.num_envs)
        self.age += 1
        crashed, arrived = self.position <= 0, self.position >= 0.995
        self._rewards[:] = np.where(crashed, -100.0, 100 * (self.position - before))
        terminated = crashed | arrived
        truncated = self.age >= self.keywords["max_episode_steps"]
        infos: dict[str, Any] = {"completeness": self.position.copy(), "_completeness": np.ones(self.num_envs, bool)}
        ended = terminated | truncated
        observations = self._observe()
        if ended.any():
            finals = np.full(self.num_envs, None, dtype=object)
            for world in np.flatnonzero(ended):
                finals[world] = self._of(observations, world)
            final_info = {"completeness": self.position.copy(), "_completeness": ended, "collision": crashed}
            infos |= {"final_obs": finals, "_final_obs": ended, "final_info": final_info, "_final_info": ended}
            self._restart(np.flatnonzero(ended))
            observations = self._observe()
        return observations, self._rewards, terminated, truncated, infos

    def render(self) -> Any:
        return tuple(np.full((4, 6, 3), world, dtype=np.uint8) for world in range(self.num_envs))

    def levels(self, factor: int) -> list[int]:
        return [factor * world for world in range(self.num_envs)]

    def _restart(self, worlds: NDArray[Any]) -> None:
        for world in worlds:
            self.position[world] = self.generators[world].uniform(0.3, 0.5)
        self.previous[worlds], self.age[worlds] = 0, 0

    def _observe(self) -> Any:
        self._line[:, 0], self._line[:, 1] = self.position, self.previous / 2
        self._line[:, 2] = self.age / self.keywords["max_episode_steps"]
        if self.keywords["observation"] == "line":
            return self._line
        maps = np.zeros((self.num_envs, 1, 36, 36), dtype=np.uint8)
        maps[:, 0] = np.round(255 * self.position)[:, None, None]
        return {"map": maps, "state": self._line}

    @staticmethod
    def _of(observations: Any, world: int) -> Any:
        if isinstance(observations, dict):
            return {key: value[world].copy() for key, value in observations.items()}
        return observations[world].copy()


class RestorableLineBatch(LineBatch):
    """The same, and it can be written down."""

    def get_state(self) -> dict[str, NDArray[Any]]:
        words = []
        for generator in self.generators:
            state: Any = generator.bit_generator.state
            numbers = (state["state"]["state"], state["state"]["inc"])
            words.append([part for number in numbers for part in (number >> 64, number & (2**64 - 1))])
        return {
            "position": self.position.copy(),
            "previous": self.previous.copy(),
            "age": self.age.copy(),
            "generators": np.array(words, dtype=np.uint64),
        }

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        self.position, self.previous, self.age = (state[key].copy() for key in ("position", "previous", "age"))
        for generator, words in zip(self.generators, state["generators"].tolist(), strict=True):
            numbers = {"state": (words[0] << 64) | words[1], "inc": (words[2] << 64) | words[3]}
            generator.bit_generator.state = {"bit_generator": "PCG64", "state": numbers, "has_uint32": 0, "uinteger": 0}


class MaskedLineBatch(RestorableLineBatch):
    """The same, and it never allows to go left."""

    def action_masks(self) -> NDArray[Any]:
        return np.tile([True, True, False], (self.num_envs, 1))


class NextStepBatch(LineBatch):
    """Restarts one step too late."""

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP}  # noqa: RUF012


def _single(**keywords: Any) -> Any:
    raise NotImplementedError("the fake has batches only")


_BATCHES = {
    "Line-v0": RestorableLineBatch,
    "Masked-v0": MaskedLineBatch,
    "Stranger-v0": LineBatch,
    "Late-v0": NextStepBatch,
}
for _name, _batch in _BATCHES.items():
    if f"fakebatch/{_name}" not in gym.registry:
        gym.register(f"fakebatch/{_name}", entry_point=_single, vector_entry_point=_batch)
if "fakebatch/Single-v0" not in gym.registry:
    gym.register("fakebatch/Single-v0", entry_point=_single)

ID = "tests.agents.fake_batch:fakebatch/Line-v0"
