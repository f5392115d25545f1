"""Worlds without a batch of their own, one after the other in this process: any environment of Gymnasium's trains."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers import TimeLimit
from numpy.typing import NDArray

Arrays = dict[str, NDArray[Any]]


class SyncWorlds(SyncVectorEnv):
    """Gymnasium's ``SyncVectorEnv`` whose worlds begin their next episode in the step in which one ends.

    Args:
        makers: Each makes one world.

    Attributes:
        restorable: Whether every world has ``get_state()`` (a dictionary of arrays) and ``set_state(state)``, without
            which the batch cannot be written down either.
    """

    def __init__(self, makers: Sequence[Callable[[], gym.Env[Any, Any]]]) -> None:
        super().__init__(makers, autoreset_mode=AutoresetMode.SAME_STEP)
        inner = [env.unwrapped for env in self.envs]
        self.restorable = all(hasattr(env, "get_state") and hasattr(env, "set_state") for env in inner)

    def get_state(self) -> Arrays:
        """Everything that later steps depend on, Gymnasium's ``TimeLimit`` included.

        The arrays of world 3 have names that begin with ``3.``
        """
        state: Arrays = {"elapsed_steps": np.array([[limit._elapsed_steps or 0 for limit in self._limits()]])}
        for world, env in enumerate(self.envs):
            own: Any = env.unwrapped
            state |= {f"{world}.{name}": np.asarray(array) for name, array in own.get_state().items()}
        return state

    def set_state(self, state: Arrays) -> None:
        """Continue where `get_state` was called."""
        for world, env in enumerate(self.envs):
            own: Any = env.unwrapped
            prefix = f"{world}."
            own.set_state({name.removeprefix(prefix): state[name] for name in state if name.startswith(prefix)})
        for limit, elapsed in zip(self._limits(), state["elapsed_steps"].ravel().tolist(), strict=True):
            limit._elapsed_steps = elapsed

    def _limits(self) -> Iterator[Any]:
        for env in self.envs:
            while isinstance(env, gym.Wrapper):
                if isinstance(env, TimeLimit):
                    yield env
                env = env.env
