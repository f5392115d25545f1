"""Checkpoints for exact resumption: everything that the next update depends on, as safetensors, arrays and JSON.

A checkpoint is taken between two updates, when the rollout buffer is empty. It holds the weights, Adam's moments, the
states of the Python, NumPy and PyTorch generators, the last observations, the worlds themselves and the statistics of
the rewards; a training that goes on from it takes the same steps, to the bit, as one that was never stopped. The one
exception are environments without ``get_state`` and ``set_state`` (none of Lidarena's): their worlds start over.
"""

import hashlib
import json
import random
import re
import shutil
import zipfile
from collections import deque
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import safetensors.torch
import torch
from numpy.typing import NDArray
from safetensors import SafetensorError
from stable_baselines3 import PPO

from lidarena.agents.networks import set_weights, weights_of
from lidarena.agents.vec_env import BatchVecEnv, Restorable
from lidarena.base.errors import ConfigError
from lidarena.base.files import write_folder

Arrays = dict[str, NDArray[Any]]

KEPT = 2
"""Checkpoints that stay in the folder of a training that goes on: the newest, and one before it."""

_VERSION = 3
_FILES = ("model.safetensors", "worlds.npz", "trainer.npz", "trainer.json")
_NORMALIZER = ("mean", "var", "count")


def save(run_folder: Path, model: PPO, seconds: float, made_with: Mapping[str, Any], keep: int = KEPT) -> Path:
    """Write a checkpoint of a training between two updates, and remove all but the last ``keep``.

    Args:
        run_folder: Of the training.
        model: PPO on a `BatchVecEnv`.
        seconds: That the training has taken so far.
        made_with: What the steps so far depend on, see ``run_folder.fixed_part``.
        keep: How many checkpoints stay.

    Returns:
        The folder of the checkpoint, ``checkpoints/step_…``; it appears whole or not at all.
    """
    folder = run_folder / "checkpoints" / f"step_{model.num_timesteps:013d}"
    if not folder.exists():
        write_folder(folder, lambda temporary: _fill(temporary, model, seconds, made_with))
    for old in _folders(run_folder)[:-keep]:
        shutil.rmtree(old)
    return folder


def newest(run_folder: Path) -> Path | None:
    """Return the last checkpoint of a run folder, or none."""
    folders = _folders(run_folder)
    return folders[-1] if folders else None


def step_of(folder: Path) -> int:
    """Return the step at which a checkpoint was taken."""
    return int(folder.name.removeprefix("step_"))


def restore(folder: Path, model: PPO, made_with: Mapping[str, Any]) -> float:
    """Put a freshly made training into the state of a checkpoint.

    Args:
        folder: Of the checkpoint.
        model: PPO as it was made at the start of that training; its next ``learn(reset_num_timesteps=False)`` goes on.
        made_with: What the checkpoint must have been made with, as for `save`.

    Returns:
        Seconds that the training had taken.

    Raises:
        ConfigError: A file of the checkpoint is missing or damaged, or belongs to another configuration.
    """
    for name in _FILES:
        if not (folder / name).is_file():
            raise ConfigError(
                f"the checkpoint {str(folder)!r} lacks {name}, so the training cannot go on from it{_older(folder)}"
            )
    try:
        about = json.loads((folder / "trainer.json").read_text(encoding="utf-8"))
        _check(folder, about, made_with)
        _restore_model(safetensors.torch.load_file(folder / "model.safetensors"), model)
        arrays = _load_arrays(folder / "trainer.npz")
        _restore_worlds(_load_arrays(folder / "worlds.npz"), arrays, model)
        _restore_trainer(arrays, about, model)
        _restore_generators(arrays, about, model)  # last, since making the worlds may have drawn from them
        return float(about["seconds"])
    except ConfigError:
        raise
    except (SafetensorError, ValueError, KeyError, TypeError, IndexError, RuntimeError, OSError, EOFError) as error:
        raise ConfigError(f"the checkpoint {str(folder)!r} is damaged: {error}{_older(folder)}") from None
    except zipfile.BadZipFile:
        raise ConfigError(
            f"the checkpoint {str(folder)!r} is damaged: one of its arrays is truncated{_older(folder)}"
        ) from None


def _check(folder: Path, about: Mapping[str, Any], made_with: Mapping[str, Any]) -> None:
    """Refuse a checkpoint of another version or configuration, and files that are not those that were saved."""
    if about["version"] != _VERSION:
        raise ConfigError(f"the checkpoint {str(folder)!r} is of version {about['version']}, not {_VERSION}")
    saved, wanted = about["made_with"], json.loads(json.dumps(dict(made_with)))
    for key in sorted(saved.keys() | wanted.keys()):
        if saved.get(key) != wanted.get(key):
            raise ConfigError(
                f"the checkpoint {str(folder)!r} is of another training, made with {key} = {saved.get(key)!r} where "
                f"this one has {wanted.get(key)!r}"
            )
    for name, digest in about["sha256"].items():
        if _digest(folder / name) != digest:
            raise ConfigError(
                f"the checkpoint {str(folder)!r} is damaged: {name} is not the file that was saved{_older(folder)}"
            )


def _older(folder: Path) -> str:
    """What to do where a checkpoint is of no use but an older one is there."""
    before = [path for path in _folders(folder.parent.parent) if path.name < folder.name]
    return f"; without that folder it goes on from step {step_of(before[-1]):,}" if before else ""


def _digest(file: Path) -> str:
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def batch_of(model: PPO) -> BatchVecEnv:
    """Return the adapter under Stable-Baselines3's own wrappers."""
    env = model.get_env()
    batch = env.unwrapped if env is not None else None
    if not isinstance(batch, BatchVecEnv):
        raise TypeError("the model was not made on a BatchVecEnv")
    return batch


def _folders(run_folder: Path) -> list[Path]:
    named = (run_folder / "checkpoints").glob("step_*")
    return sorted(path for path in named if re.fullmatch(r"step_\d{13}", path.name) and path.is_dir())


def _fill(folder: Path, model: PPO, seconds: float, made_with: Mapping[str, Any]) -> None:
    weights = {f"policy.{name}": tensor for name, tensor in weights_of(model.policy).items()}
    moments = {
        f"optimizer.{index}.{name}": tensor
        for index, state in model.policy.optimizer.state_dict()["state"].items()
        for name, tensor in state.items()
    }
    tensors = {name: tensor.detach().cpu().contiguous() for name, tensor in (weights | moments).items()}
    (folder / "model.safetensors").write_bytes(safetensors.torch.save(tensors))
    worlds = batch_of(model).env.unwrapped
    _save_arrays(folder / "worlds.npz", worlds.get_state() if isinstance(worlds, Restorable) else {})
    _save_arrays(folder / "trainer.npz", _trainer_arrays(model))
    about = {
        "version": _VERSION,
        "made_with": dict(made_with),
        "sha256": {name: _digest(folder / name) for name in _FILES[:-1]},
        "num_timesteps": model.num_timesteps,
        "n_updates": model._n_updates,
        "seconds": seconds,
        "episodes": list(model.ep_info_buffer or ()),
        "python_random": random.getstate(),
        "numpy_random": {**np.random.get_state(legacy=False), "state": None},
        "numpy_position": int(np.random.get_state(legacy=False)["state"]["pos"]),
    }
    (folder / "trainer.json").write_text(json.dumps(about), encoding="utf-8")


def _trainer_arrays(model: PPO) -> Arrays:
    arrays = {f"batch.{key}": value for key, value in batch_of(model).get_state().items()}
    observations = model._last_obs
    if isinstance(observations, dict):
        arrays |= {f"last_obs.{key}": value for key, value in observations.items()}
    else:
        arrays["last_obs"] = np.asarray(observations)
    arrays["last_episode_starts"] = np.asarray(model._last_episode_starts)
    arrays["torch_random"] = torch.get_rng_state().numpy()
    arrays["numpy_random"] = np.random.get_state(legacy=False)["state"]["key"]
    if model.device.type == "cuda":
        arrays["cuda_random"] = torch.cuda.get_rng_state(model.device).numpy()
    normalizer = model.get_vec_normalize_env()
    if normalizer is not None:
        arrays |= {f"reward.{key}": np.asarray(getattr(normalizer.ret_rms, key)) for key in _NORMALIZER}
        arrays["reward.returns"] = normalizer.returns
    return arrays


def _restore_model(tensors: dict[str, torch.Tensor], model: PPO) -> None:
    prefix = "policy."
    weights = {name.removeprefix(prefix): tensor for name, tensor in tensors.items() if name.startswith(prefix)}
    set_weights(model.policy, weights)
    moments: dict[int, dict[str, torch.Tensor]] = {}
    for name, tensor in tensors.items():
        if name.startswith("optimizer."):
            _, index, key = name.split(".")
            moments.setdefault(int(index), {})[key] = tensor
    optimizer = model.policy.optimizer
    optimizer.load_state_dict({"state": moments, "param_groups": optimizer.state_dict()["param_groups"]})


def _restore_worlds(state: Arrays, arrays: Arrays, model: PPO) -> None:
    """Put the worlds back, and what the training saw of them last."""
    batch = batch_of(model)
    env = model.get_env()
    model._last_obs = env.reset() if env is not None else None  # type: ignore[assignment]  # an array or a dict
    model._last_episode_starts = np.ones(batch.num_envs, dtype=bool)
    batch.episodes = int(arrays["batch.episodes"])
    worlds = batch.env.unwrapped
    if isinstance(worlds, Restorable):
        worlds.set_state(state)
        batch.set_state({key.removeprefix("batch."): arrays[key] for key in arrays if key.startswith("batch.")})
        named = {key.removeprefix("last_obs."): arrays[key] for key in arrays if key.startswith("last_obs.")}
        model._last_obs = named or arrays["last_obs"]
        model._last_episode_starts = arrays["last_episode_starts"]


def _restore_trainer(arrays: Arrays, about: dict[str, Any], model: PPO) -> None:
    normalizer = model.get_vec_normalize_env()
    if normalizer is not None:
        mean, variance, count = (arrays[f"reward.{key}"] for key in _NORMALIZER)
        normalizer.ret_rms.mean, normalizer.ret_rms.var, normalizer.ret_rms.count = mean, variance, float(count)
        normalizer.returns = arrays["reward.returns"]
    model.num_timesteps = int(about["num_timesteps"])
    model._n_updates = int(about["n_updates"])
    model.ep_info_buffer = deque(about["episodes"], maxlen=model._stats_window_size)
    model.ep_success_buffer = deque(maxlen=model._stats_window_size)


def _restore_generators(arrays: Arrays, about: dict[str, Any], model: PPO) -> None:
    version, words, gauss = about["python_random"]
    random.setstate((version, tuple(words), gauss))
    position = {"key": arrays["numpy_random"], "pos": about["numpy_position"]}
    np.random.set_state({**about["numpy_random"], "state": position})
    torch.set_rng_state(torch.from_numpy(arrays["torch_random"]))
    if model.device.type == "cuda" and "cuda_random" in arrays:
        torch.cuda.set_rng_state(torch.from_numpy(arrays["cuda_random"]), model.device)


def _save_arrays(path: Path, arrays: Arrays) -> None:
    for key, value in arrays.items():
        if np.asarray(value).dtype.hasobject:
            raise TypeError(f"the state {key!r} holds Python objects, which only a pickle could keep")
    np.savez(path, allow_pickle=False, **arrays)  # compressing takes ten times as long, which is felt between updates


def _load_arrays(path: Path) -> Arrays:
    with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
        return {key: archive[key] for key in archive.files}
