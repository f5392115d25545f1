"""A training between two updates as tensors, arrays and plain JSON, and back: what the next update depends on."""

import random
from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from sb3_contrib import RecurrentPPO
from sb3_contrib.common.recurrent.type_aliases import RNNStates
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.running_mean_std import RunningMeanStd
from torch.optim import Optimizer

from lidarena.agents.learners import optimizers
from lidarena.agents.network_weights import set_weights, weights_of
from lidarena.agents.observation_normalizer import running_statistics
from lidarena.agents.vec_env import BatchVecEnv, restorable
from lidarena.base.generator_state import generator_from_words, generator_words

Arrays = dict[str, NDArray[Any]]

_STATISTICS = ("mean", "var", "count")
_COUNTERS = ("num_timesteps", "_n_updates", "_episode_num", "_n_calls", "exploration_rate")


def batch_of(model: BaseAlgorithm) -> BatchVecEnv:
    """Return the adapter under Stable-Baselines3's own wrappers."""
    env = model.get_env()
    batch = env.unwrapped if env is not None else None
    if not isinstance(batch, BatchVecEnv):
        raise TypeError("the model was not made on a BatchVecEnv")
    return batch


def tensors_of(model: BaseAlgorithm) -> dict[str, torch.Tensor]:
    """Weights, the moments of the optimizers, and SAC's learned weight of the entropy."""
    tensors = {f"policy.{name}": tensor for name, tensor in weights_of(model.policy).items()}
    for name, optimizer in optimizers(model).items():
        for index, state in optimizer.state_dict()["state"].items():
            tensors |= {f"{name}.{index}.{key}": tensor for key, tensor in state.items()}
    entropy = getattr(model, "log_ent_coef", None)
    if entropy is not None:
        tensors["log_ent_coef"] = entropy
    return {name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}


def set_tensors(tensors: Mapping[str, torch.Tensor], model: BaseAlgorithm) -> None:
    """Put back what `tensors_of` returned."""
    set_weights(model.policy, _part(tensors, "policy."))
    for name, optimizer in optimizers(model).items():
        _set_moments(_part(tensors, f"{name}."), optimizer)
    entropy = getattr(model, "log_ent_coef", None)
    if entropy is not None:
        with torch.no_grad():
            entropy.copy_(tensors["log_ent_coef"])


def _set_moments(tensors: Mapping[str, torch.Tensor], optimizer: Optimizer) -> None:
    moments: dict[int, dict[str, torch.Tensor]] = {}
    for name, tensor in tensors.items():
        index, key = name.split(".")
        moments.setdefault(int(index), {})[key] = tensor
    optimizer.load_state_dict({"state": moments, "param_groups": optimizer.state_dict()["param_groups"]})


def worlds_of(model: BaseAlgorithm) -> Arrays:
    """The worlds in the middle of their episodes; nothing where they cannot be written down."""
    worlds = batch_of(model).env.unwrapped
    return worlds.get_state() if restorable(worlds) else {}


def arrays_of(model: BaseAlgorithm) -> Arrays:
    """Observations, statistics, memories of LSTMs, and generators."""
    arrays = {f"batch.{key}": value for key, value in batch_of(model).get_state().items()}
    arrays |= _named("last_obs", model._last_obs) | _named("last_original_obs", model._last_original_obs)
    arrays["last_episode_starts"] = np.asarray(model._last_episode_starts)
    arrays["torch_random"] = torch.get_rng_state().numpy()
    arrays["numpy_random"] = np.random.get_state(legacy=False)["state"]["key"]
    arrays["action_random"] = generator_words(model.action_space.np_random)
    if model.device.type == "cuda":
        arrays["cuda_random"] = torch.cuda.get_rng_state(model.device).numpy()
    normalizer = model.get_vec_normalize_env()
    if normalizer is not None:
        arrays["reward.returns"] = normalizer.returns
    for name, one in _statistics(model).items():
        arrays |= {f"{name}.{key}": np.asarray(getattr(one, key)) for key in _STATISTICS}
    if isinstance(model, RecurrentPPO):
        arrays |= {f"lstm.{index}": state.cpu().numpy() for index, state in enumerate(_lstm_states(model))}
    return arrays


def _lstm_states(model: RecurrentPPO) -> list[torch.Tensor]:
    states: Any = model._last_lstm_states
    return [*states.pi, *states.vf]


def set_arrays(worlds: Arrays, arrays: Arrays, model: BaseAlgorithm) -> None:
    """Put back the worlds, and everything that `arrays_of` returned except the generators.

    Worlds that cannot be written down begin new episodes.
    """
    _set_statistics(arrays, model)
    env, batch = model.get_env(), batch_of(model)
    normalizer = model.get_vec_normalize_env()
    model._last_obs = _first_observations(model)
    model._last_original_obs = normalizer.get_original_obs() if normalizer is not None else None
    model._last_episode_starts = np.ones(batch.num_envs, dtype=bool)
    batch.episodes = int(arrays["batch.episodes"])
    if env is None or not restorable(batch.env.unwrapped):
        return
    batch.env.unwrapped.set_state(worlds)
    batch.set_state(_part(arrays, "batch."))
    model._last_obs = _observations(arrays, "last_obs")
    model._last_original_obs = _observations(arrays, "last_original_obs")
    model._last_episode_starts = arrays["last_episode_starts"]
    if normalizer is not None:
        normalizer.returns = arrays["reward.returns"]
    if isinstance(model, RecurrentPPO):
        states = [torch.from_numpy(arrays[f"lstm.{index}"]).to(model.device) for index in range(4)]
        recurrent: Any = model
        recurrent._last_lstm_states = RNNStates((states[0], states[1]), (states[2], states[3]))


def _first_observations(model: BaseAlgorithm) -> Any:
    """Begin episodes without counting their first observations, which the statistics have seen elsewhere."""
    env, normalizer = model.get_env(), model.get_vec_normalize_env()
    assert env is not None
    if normalizer is None:
        return env.reset()
    normalizer.training = False
    observations = env.reset()
    normalizer.training = True
    return observations


def _statistics(model: BaseAlgorithm) -> dict[str, RunningMeanStd]:
    """What is known of rewards and observations, by the names that a checkpoint gives them."""
    normalizer = model.get_vec_normalize_env()
    if normalizer is None:
        return {}
    known = {f"observation.{key}": one for key, one in running_statistics(normalizer).items()}
    return {"reward": normalizer.ret_rms} | known


def _set_statistics(arrays: Arrays, model: BaseAlgorithm) -> None:
    for name, one in _statistics(model).items():
        mean, variance, count = (arrays[f"{name}.{key}"] for key in _STATISTICS)
        one.mean, one.var, one.count = mean, variance, float(count)


def _named(name: str, observations: Any) -> Arrays:
    """Observations, an array or a dictionary of arrays, under names that begin with ``name``."""
    if observations is None:
        return {}
    if isinstance(observations, dict):
        return {f"{name}.{key}": value for key, value in observations.items()}
    return {name: np.asarray(observations)}


def _observations(arrays: Arrays, name: str) -> Any:
    return arrays.get(name) if name in arrays else _part(arrays, f"{name}.") or None


def _part(named: Mapping[str, Any], prefix: str) -> dict[str, Any]:
    return {name.removeprefix(prefix): value for name, value in named.items() if name.startswith(prefix)}


def numbers_of(model: BaseAlgorithm) -> dict[str, Any]:
    """Counters, what the last episodes told, and generators, as plain JSON."""
    generator = np.random.get_state(legacy=False)
    return {name.removeprefix("_"): getattr(model, name) for name in _COUNTERS if hasattr(model, name)} | {
        "episodes": list(model.ep_info_buffer or ()),
        "python_random": random.getstate(),
        "numpy_random": {**generator, "state": None},
        "numpy_position": int(generator["state"]["pos"]),
    }


def set_numbers(numbers: Mapping[str, Any], model: BaseAlgorithm) -> None:
    """Put back what `numbers_of` returned, except the generators."""
    for name in _COUNTERS:
        if hasattr(model, name) and name.removeprefix("_") in numbers:
            setattr(model, name, numbers[name.removeprefix("_")])
    model.ep_info_buffer = deque(numbers["episodes"], maxlen=model._stats_window_size)
    model.ep_success_buffer = deque(maxlen=model._stats_window_size)


def set_generators(arrays: Arrays, numbers: Mapping[str, Any], model: BaseAlgorithm) -> None:
    """Put all generators where they were; last of all, since making worlds may draw from them."""
    version, words, gauss = numbers["python_random"]
    random.setstate((version, tuple(words), gauss))
    position = {"key": arrays["numpy_random"], "pos": numbers["numpy_position"]}
    np.random.set_state({**numbers["numpy_random"], "state": position})
    torch.set_rng_state(torch.from_numpy(arrays["torch_random"]))
    if "action_random" in arrays:
        model.action_space._np_random = generator_from_words(arrays["action_random"])
    if model.device.type == "cuda" and "cuda_random" in arrays:
        torch.cuda.set_rng_state(torch.from_numpy(arrays["cuda_random"]), model.device)
