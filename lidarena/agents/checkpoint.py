"""Checkpoints for exact resumption: everything that the next update depends on, as safetensors, arrays and JSON.

A checkpoint is taken between two updates, when a rollout buffer is empty. It holds the weights, Adam's moments, the
states of the Python, NumPy and PyTorch generators, the last observations, the worlds themselves, what LSTMs remember,
the statistics of rewards and observations, and the memory of transitions of a learner that has one; a training that
goes on from it takes the same steps, to the bit, as one that was never stopped. Two things may be lost, and are told
then: the running episodes of worlds without ``get_state`` and ``set_state`` (none of Lidarena's), which start over, and
a memory of transitions that is larger than `replay_memory.LARGEST`.
"""

import hashlib
import json
import re
import shutil
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import safetensors.torch
from numpy.typing import NDArray
from safetensors import SafetensorError
from stable_baselines3.common.base_class import BaseAlgorithm

from lidarena.agents.learner_config import ON_POLICY
from lidarena.agents.replay_memory import memory_of, set_memory
from lidarena.agents.trainer_state import (
    arrays_of,
    batch_of,
    numbers_of,
    set_arrays,
    set_generators,
    set_numbers,
    set_tensors,
    tensors_of,
    worlds_of,
)
from lidarena.agents.vec_env import restorable
from lidarena.base.errors import ConfigError
from lidarena.base.files import write_folder

Arrays = dict[str, NDArray[Any]]

KEPT = 2
"""Checkpoints that stay in the folder of a training that goes on: the newest, and one before it."""

_VERSION = 4
_VERSION_0_1 = 3
"""Of Lidarena 0.1, whose keywords of the environment had other names."""
_KEYWORDS = "env.keywords."
_FILES = ("model.safetensors", "worlds.npz", "trainer.npz", "trainer.json")
_MEMORY = "memory.npz"

MAY_CHANGE = tuple(f"{block}.ent_coef" for block in ON_POLICY)
"""What may differ when a training goes on although it changes the updates: it may end without the entropy bonus that
made it try enough. (Checkpoints tell it all the same if they were made before it was free.)"""


def save(
    run_folder: Path, model: BaseAlgorithm, seconds: float, made_with: Mapping[str, Any], keep: int = KEPT
) -> Path:
    """Write a checkpoint of a training between two updates, and remove all but the last ``keep``.

    Args:
        run_folder: Of the training.
        model: BaseAlgorithm on a `BatchVecEnv`.
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


def restore(folder: Path, model: BaseAlgorithm, made_with: Mapping[str, Any]) -> tuple[float, list[str]]:
    """Put a freshly made training into the state of a checkpoint.

    Args:
        folder: Of the checkpoint.
        model: As it was made at the start of that training; its next ``learn(reset_num_timesteps=False)`` goes on.
        made_with: What the checkpoint must have been made with, as for `save`.

    Returns:
        Seconds that the training had taken, and what is lost, each the end of a sentence; mostly nothing.

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
        return float(about["seconds"]), _restore(folder, about, model)
    except ConfigError:
        raise
    except (SafetensorError, ValueError, KeyError, TypeError, IndexError, RuntimeError, OSError, EOFError) as error:
        raise ConfigError(f"the checkpoint {str(folder)!r} is damaged: {error}{_older(folder)}") from None
    except zipfile.BadZipFile:
        raise ConfigError(
            f"the checkpoint {str(folder)!r} is damaged: one of its arrays is truncated{_older(folder)}"
        ) from None


def _restore(folder: Path, about: Mapping[str, Any], model: BaseAlgorithm) -> list[str]:
    """Put everything back; what is lost."""
    set_tensors(safetensors.torch.load_file(folder / "model.safetensors"), model)
    arrays = _load_arrays(folder / "trainer.npz")
    set_arrays(_load_arrays(folder / "worlds.npz"), arrays, model)
    set_numbers(about, model)
    forgotten = set_memory(_load_arrays(folder / _MEMORY) if (folder / _MEMORY).exists() else {}, model)
    set_generators(arrays, about, model)
    return [lost for lost in (lost_worlds(model), forgotten) if lost]


def lost_worlds(model: BaseAlgorithm) -> str | None:
    """What a resumption loses of the worlds, as the end of a sentence; None if nothing."""
    if restorable(batch_of(model).env.unwrapped):
        return None
    return "the worlds' running episodes: without get_state() and set_state() they begin new ones"


def _check(folder: Path, about: Mapping[str, Any], made_with: Mapping[str, Any]) -> None:
    """Refuse a checkpoint of another version or configuration, and files that are not those that were saved."""
    if about["version"] not in (_VERSION, _VERSION_0_1):
        raise ConfigError(f"the checkpoint {str(folder)!r} is of version {about['version']}, not {_VERSION}")
    saved, wanted = about["made_with"], json.loads(json.dumps(dict(made_with)))
    for key in sorted((saved.keys() | wanted.keys()) - set(MAY_CHANGE)):
        renamed = about["version"] == _VERSION_0_1 and f"{key}.".startswith(_KEYWORDS)
        if not renamed and saved.get(key) != wanted.get(key):
            raise ConfigError(
                f"the checkpoint {str(folder)!r} is of another training, made with {key} = {saved.get(key)!r} where "
                f"this one has {wanted.get(key)!r}"
            )
    for name, digest in about["sha256"].items():
        if not (folder / name).is_file():
            raise ConfigError(
                f"the checkpoint {str(folder)!r} lacks {name}, so the training cannot go on from it{_older(folder)}"
            )
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


def _folders(run_folder: Path) -> list[Path]:
    named = (run_folder / "checkpoints").glob("step_*")
    return sorted(path for path in named if re.fullmatch(r"step_\d{13}", path.name) and path.is_dir())


def _fill(folder: Path, model: BaseAlgorithm, seconds: float, made_with: Mapping[str, Any]) -> None:
    (folder / "model.safetensors").write_bytes(safetensors.torch.save(tensors_of(model)))
    _save_arrays(folder / "worlds.npz", worlds_of(model))
    _save_arrays(folder / "trainer.npz", arrays_of(model))
    memory = memory_of(model)
    if memory:
        _save_arrays(folder / _MEMORY, memory)
    about = {
        "version": _VERSION,
        "made_with": dict(made_with),
        "sha256": {file.name: _digest(file) for file in sorted(folder.iterdir())},
        "seconds": seconds,
        **numbers_of(model),
    }
    (folder / "trainer.json").write_text(json.dumps(about), encoding="utf-8")


def _save_arrays(path: Path, arrays: Arrays) -> None:
    for key, value in arrays.items():
        if np.asarray(value).dtype.hasobject:
            raise TypeError(f"the state {key!r} holds Python objects, which only a pickle could keep")
    np.savez(path, allow_pickle=False, **arrays)  # compressing takes ten times as long, which is felt between updates


def _load_arrays(path: Path) -> Arrays:
    with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
        return {key: archive[key] for key in archive.files}
