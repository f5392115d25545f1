"""Tiny single environments of a stranger's, without any batch; `tests.agents.fake_single:stranger/Walk-v0`."""

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray


class WalkEnv(gym.Env[NDArray[np.float32], Any]):
    """Walk right from 0.5 to 1; 0 is a collision. ``masked`` rules out going left."""

    def __init__(self, masked: bool = False, start: int = 0) -> None:
        self.observation_space = spaces.Box(-1, 2, (2,), np.float32)
        self.action_space = spaces.Discrete(2, start=start)
        self.position = 0.5
        if masked:
            self.action_masks = lambda: np.array([self.begun, True])

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[NDArray[np.float32], dict[str, Any]]:
        super().reset(seed=seed)
        self.position, self.begun = 0.5 + 0.1 * self.np_random.normal(), False
        return self._observe(), {}

    def step(self, action: Any) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        self.position += (0.1 if action == 1 else -0.1) + 0.02 * self.np_random.normal()
        success, collision = self.position >= 1, self.position <= 0
        info = {"success": success, "collision": collision, "what": "a word", "picture": np.zeros((2, 2))}
        return self._observe(), float(success), bool(success or collision), False, info

    def _observe(self) -> NDArray[np.float32]:
        return np.clip(np.array([self.position, 0.0], np.float32), -1, 2)


class RestorableWalkEnv(WalkEnv):
    """The same, and it can be written down."""

    def get_state(self) -> dict[str, NDArray[Any]]:
        state: Any = self.np_random.bit_generator.state
        numbers = (state["state"]["state"], state["state"]["inc"])
        words = [part for number in numbers for part in (number >> 64, number & (2**64 - 1))]
        return {"position": np.array(self.position), "words": np.array(words, np.uint64)}

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        self.position = float(state["position"])
        words = state["words"].tolist()
        numbers = {"state": (words[0] << 64) | words[1], "inc": (words[2] << 64) | words[3]}
        bits = {"bit_generator": "PCG64", "state": numbers, "has_uint32": 0, "uinteger": 0}
        self.np_random.bit_generator.state = bits


for _name, _kind in {"Walk-v0": WalkEnv, "Restorable-v0": RestorableWalkEnv}.items():
    if f"stranger/{_name}" not in gym.registry:
        gym.register(f"stranger/{_name}", entry_point=_kind, max_episode_steps=15)
