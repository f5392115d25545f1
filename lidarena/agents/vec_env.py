"""A batch of worlds as Stable-Baselines3 wants it: its own `VecEnv` over a Gymnasium `VectorEnv`."""

import time
from collections.abc import Iterable, Sequence
from typing import Any, Protocol, TypeGuard, runtime_checkable

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, SyncVectorEnv, VectorEnv
from numpy.typing import NDArray
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import VecEnv
from stable_baselines3.common.vec_env.base_vec_env import VecEnvObs, VecEnvStepReturn

from lidarena.base.errors import ConfigError

Arrays = dict[str, NDArray[Any]]

_LOGGED = ("completeness", "success", "is_success", "collision", "path_length", "time")


@runtime_checkable
class Restorable(Protocol):
    """A batch of worlds that can be written down in the middle of its episodes, random generators included."""

    def get_state(self) -> Arrays:
        """Everything that later steps depend on, as arrays without Python objects."""

    def set_state(self, state: Arrays) -> None:
        """Continue where `get_state` was called."""


def restorable(worlds: Any) -> TypeGuard[Restorable]:
    """Whether a batch can be written down; one that only may be able to says so by an attribute ``restorable``."""
    return isinstance(worlds, Restorable) and bool(getattr(worlds, "restorable", True))


class BatchVecEnv(VecEnv):
    """Adapter from Gymnasium's `VectorEnv` with autoreset ``SAME_STEP`` to Stable-Baselines3's `VecEnv`.

    What Stable-Baselines3 counts on, and a batch that reuses its buffers does not give by itself:

    - every array that `step_wait` returns is fresh, since the rollout buffer keeps the last one until the next step;
    - the ``info`` of a world that has just ended holds ``terminal_observation``, ``TimeLimit.truncated`` (true only if
      it was cut off without having terminated) and ``episode``: ``r`` return, ``l`` length in steps, ``t`` seconds
      since the adapter was made, and, where the environment tells them, ``completeness`` (fraction), ``success``,
      ``is_success`` and ``collision`` (0 or 1), ``path_length`` [m] and ``time`` [s]; of a team their means over the
      robots. The ``info`` of every other world is empty.

    Attributes:
        env: The batch.
        episodes: Episodes that have ended so far.
    """

    def __init__(self, env: VectorEnv[Any, Any, Any]) -> None:
        """Adapt a batch.

        Args:
            env: The batch.

        Raises:
            ConfigError: Its worlds do not restart in the step in which they end.
        """
        mode = env.metadata.get("autoreset_mode")
        if mode is not AutoresetMode.SAME_STEP:
            raise ConfigError(f"the batch of worlds has autoreset mode {mode}, but training needs SAME_STEP")
        self.env = env
        self.episodes = 0
        self._returns = np.zeros(env.num_envs)
        self._lengths = np.zeros(env.num_envs, dtype=np.int64)
        self._started = time.perf_counter()
        self._actions: NDArray[Any] | None = None
        super().__init__(env.num_envs, env.single_observation_space, env.single_action_space)

    def reset(self) -> VecEnvObs:
        """Start an episode in every world, with the seeds of the last `seed` if it has not been used yet."""
        if any(options != self._options[0] for options in self._options):
            raise NotImplementedError("all worlds of a batch are reset with the same options")
        options: dict[str, Any] | None = self._options[0] or None
        observations, infos = self.env.reset(seed=self._seeds[0], options=options)
        self._reset_seeds()
        self._reset_options()
        self._returns[:] = 0.0
        self._lengths[:] = 0
        self.reset_infos = [_of_world(infos, world) for world in range(self.num_envs)]
        first: VecEnvObs = _fresh(observations)
        return first

    def step_async(self, actions: NDArray[Any]) -> None:
        """Keep the actions for `step_wait`."""
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        """Step every world; see the class for what the infos hold."""
        observations, rewards, terminated, truncated, infos = self.env.step(self._actions)
        done = np.logical_or(terminated, truncated)
        self._returns += rewards
        self._lengths += 1
        world_infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for world in np.flatnonzero(done):
            world_infos[world] = self._last_info(int(world), infos, bool(truncated[world] and not terminated[world]))
        self._returns[done] = 0.0
        self._lengths[done] = 0
        return _fresh(observations), np.array(rewards, dtype=np.float32), done, world_infos

    def _last_info(self, world: int, infos: dict[str, Any], cut_off: bool) -> dict[str, Any]:
        """The ``info`` of a world whose episode has just ended."""
        episode: dict[str, float] = {
            "r": float(self._returns[world]),
            "l": int(self._lengths[world]),
            "t": round(time.perf_counter() - self._started, 6),
        }
        final = infos.get("final_info", {})
        episode.update({key: float(np.mean(final[key][world])) for key in _LOGGED if _tells(final, key, world)})
        self.episodes += 1
        return {
            "terminal_observation": _fresh(infos["final_obs"][world]),
            "TimeLimit.truncated": cut_off,
            "episode": episode,
        }

    def get_state(self) -> Arrays:
        """What the adapter itself remembers between steps, as arrays."""
        return {
            "returns": self._returns.copy(),
            "lengths": self._lengths.copy(),
            "episodes": np.array(self.episodes, dtype=np.int64),
        }

    def set_state(self, state: Arrays) -> None:
        """Continue where `get_state` was called."""
        self._returns[:] = state["returns"]
        self._lengths[:] = state["lengths"]
        self.episodes = int(state["episodes"])

    def close(self) -> None:
        """Close the batch."""
        self.env.close()

    def get_attr(self, attr_name: str, indices: int | Iterable[int] | None = None) -> list[Any]:
        """Return an attribute of the batch per world; one value per world is told apart, anything else repeated."""
        single = {"observation_space": "single_observation_space", "action_space": "single_action_space"}
        return self._spread(self._attribute(single.get(attr_name, attr_name)), indices)

    def _attribute(self, name: str) -> Any:
        """An attribute of the batch, or else of the single environments that it is made of."""
        if not hasattr(self.env, name) and isinstance(self.env.unwrapped, SyncVectorEnv):
            return [env.get_wrapper_attr(name) for env in self.env.unwrapped.envs]
        return getattr(self.env, name)

    def set_attr(self, attr_name: str, value: Any, indices: int | Iterable[int] | None = None) -> None:
        """Set an attribute of the batch, which all worlds share.

        Raises:
            NotImplementedError: Only some of the worlds are asked for.
        """
        self._require_all(indices, f"the attribute {attr_name!r}")
        setattr(self.env.unwrapped, attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: int | Iterable[int] | None = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call a method of the batch once and return its result per world, as `get_attr` does.

        A method that the batch does not have is called of every single environment that it is made of.
        """
        if not hasattr(self.env, method_name) and isinstance(self.env.unwrapped, SyncVectorEnv):
            results = self.env.unwrapped.call(method_name, *method_args, **method_kwargs)
            return self._spread(results, indices)
        return self._spread(getattr(self.env, method_name)(*method_args, **method_kwargs), indices)

    def env_is_wrapped(
        self, wrapper_class: type[gym.Wrapper[Any, Any, Any, Any]], indices: int | Iterable[int] | None = None
    ) -> list[bool]:
        """Only `Monitor` counts as there, since its ``episode`` is in the infos; worlds of a batch have no wrappers."""
        return [issubclass(wrapper_class, Monitor)] * len(list(self._get_indices(indices)))

    def get_images(self) -> Sequence[NDArray[Any] | None]:
        """Return one picture a world, uint8 (height, width, 3)."""
        pictures: Any = self.env.render()
        return [None] * self.num_envs if pictures is None else list(pictures)

    def _spread(self, value: Any, indices: int | Iterable[int] | None) -> list[Any]:
        worlds = list(self._get_indices(indices))
        if isinstance(value, (list, tuple, np.ndarray)) and np.ndim(value) and len(value) == self.num_envs:
            return [value[world] for world in worlds]
        return [value] * len(worlds)

    def _require_all(self, indices: int | Iterable[int] | None, what: str) -> None:
        if set(self._get_indices(indices)) != set(range(self.num_envs)):
            raise NotImplementedError(f"{what} is shared by all worlds of a batch, so leave indices out")


def _tells(info: dict[str, Any], key: str, world: int) -> bool:
    """Whether a world's last info holds a number, or numbers, under this key."""
    if key not in info or not info.get(f"_{key}", np.ones(world + 1, np.bool_))[world]:
        return False
    value = np.asarray(info[key][world])
    return value.dtype.kind in "biuf" and value.size > 0


def _fresh(observation: Any) -> Any:
    """A copy of an observation, array or dict of arrays."""
    if isinstance(observation, dict):
        return {key: np.array(value) for key, value in observation.items()}
    return np.array(observation)


def _of_world(infos: dict[str, Any], world: int) -> dict[str, Any]:
    """One world's ``info`` out of Gymnasium's dict of arrays with masks ``_key``."""
    own: dict[str, Any] = {}
    for key, value in infos.items():
        if key.startswith("_") and key[1:] in infos:
            continue
        mask = infos.get(f"_{key}")
        if mask is None or mask[world]:
            own[key] = _of_world(value, world) if isinstance(value, dict) else value[world]
    return own
