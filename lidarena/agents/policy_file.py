"""Trained policies on disk: weights as safetensors, the rest as JSON, nothing that can run code when it is opened."""

import hashlib
import json
from pathlib import Path
from typing import Any, Literal

import safetensors.torch
from pydantic import Field, ValidationError
from safetensors import SafetensorError
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.policies import BasePolicy

from lidarena.agents import space_json
from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.agents.network_weights import all_finite, set_weights, weights_of
from lidarena.agents.networks import Architecture, describe, rebuild
from lidarena.agents.observation_normalizer import PREFIX, ObservationNormalizer
from lidarena.agents.shipped import resolve
from lidarena.agents.training_config import EnvironmentConfig
from lidarena.base.errors import PolicyFileError
from lidarena.base.files import write_bytes, write_text
from lidarena.base.versions import library_versions
from lidarena.base.yaml_config import ConfigModel
from lidarena.envs.registration import keywords_of_version_0_1

FORMAT = "lidarena-policy"
VERSION = 2
"""Of what is written; version 1, which knew PPO alone and no normalized observations, is read as well."""


class PolicyCard(ConfigModel):
    """The content of ``policy.json``.

    Attributes:
        format: What tells such a file from other JSON.
        version: Of the format.
        env: Where the policy was trained.
        observation_space: See `space_json`.
        action_space: See `space_json`.
        architecture: Of the network.
        weights_sha256: Of the safetensors file beside it, so that two halves of different policies are noticed.
        training: Steps, seed, and so on.
        versions: Of the libraries that trained it.
    """

    format: Literal["lidarena-policy"] = "lidarena-policy"
    version: Literal[1, 2] = 2
    env: EnvironmentConfig
    observation_space: dict[str, Any]
    action_space: dict[str, Any]
    architecture: Architecture
    weights_sha256: str = Field(pattern="^[0-9a-f]{64}$")
    training: dict[str, Any] = Field(default_factory=dict)
    versions: dict[str, str | None] = Field(default_factory=dict)


def save_policy(
    model: BaseAlgorithm | BasePolicy,
    folder: str | Path,
    env_id: str,
    env_keywords: dict[str, Any] | None = None,
    training: dict[str, Any] | None = None,
    name: str = "policy",
) -> Path:
    """Write ``policy.safetensors`` and ``policy.json``.

    Args:
        model: A learner of Stable-Baselines3 or sb3-contrib (PPO, MaskablePPO, RecurrentPPO, QRDQN, SAC, TQC), with
            the statistics of the observations that its ``VecNormalize`` normalizes; or its policy alone.
        folder: Where; made if missing. Files of the same name are replaced once both new ones are whole.
        env_id: Gymnasium id of the environment it was trained in.
        env_keywords: Keywords of that environment.
        training: What should be remembered of the training; plain JSON.
        name: Of the two files.

    Returns:
        The JSON file, which `load` takes.

    Raises:
        PolicyFileError: The network is of a kind that cannot be rebuilt, or its weights are not finite.
    """
    network = model.policy if isinstance(model, BaseAlgorithm) else model
    normalizer = ObservationNormalizer.of(model.get_vec_normalize_env()) if isinstance(model, BaseAlgorithm) else None
    architecture = describe(network)
    weights = weights_of(network) | (normalizer.tensors() if normalizer is not None else {})
    weights = {key: tensor.cpu().contiguous() for key, tensor in weights.items()}
    if not all_finite(weights):
        raise PolicyFileError("the policy is not written, since some of its weights are not finite numbers")
    data = safetensors.torch.save(weights, metadata={"format": FORMAT})
    card = PolicyCard(
        env=EnvironmentConfig(id=env_id, keywords=env_keywords or {}),
        observation_space=space_json.to_json(network.observation_space),
        action_space=space_json.to_json(network.action_space),
        architecture=architecture,
        weights_sha256=hashlib.sha256(data).hexdigest(),
        training=training or {},
        versions=library_versions(),
    )
    text = json.dumps(card.model_dump(mode="json", by_alias=True), indent=2)
    write_bytes(Path(folder) / f"{name}.safetensors", data)
    return write_text(Path(folder) / f"{name}.json", text + "\n")


def read_policy(path: str | Path, deterministic: bool = True) -> LearnedPolicy:
    """Read a trained policy.

    Args:
        path: See `lidarena.agents.load`.
        deterministic: Whether the policy takes its most probable action or draws one.

    Returns:
        The network with what is known of its training.

    Raises:
        PolicyFileError: A file is missing, truncated or of another format (Stable-Baselines3's own ``.zip`` too, since
            opening one can run code).
    """
    card_file, weights_file = _find(resolve(path))
    card = _read_card(card_file)
    space = space_json.from_json(card.observation_space)
    network = rebuild(card.architecture, space, space_json.from_json(card.action_space))
    data = _read(weights_file)
    if hashlib.sha256(data).hexdigest() != card.weights_sha256:
        raise PolicyFileError(
            f"{str(weights_file)!r} is damaged or of another policy: it is not the file that {card_file.name} describes"
        )
    try:
        tensors = safetensors.torch.load(data)
        statistics = {name: tensors.pop(name) for name in [*tensors] if name.startswith(PREFIX)}
        set_weights(network, tensors)
        normalizer = ObservationNormalizer.from_tensors(statistics, space) if statistics else None
    except (SafetensorError, ValueError) as error:
        raise PolicyFileError(f"{str(weights_file)!r} does not fit {card_file.name}: {error}") from None
    keywords = dict(card.env.keywords)
    if card.version == 1:
        keywords = keywords_of_version_0_1(card.env.id, keywords)
    return LearnedPolicy(network, card.env.id, keywords, dict(card.training), deterministic, normalizer)


def _find(path: Path) -> tuple[Path, Path]:
    """The two files that ``path`` stands for."""
    if path.is_dir():
        path = path / "policy.json"
        if not path.exists():
            raise PolicyFileError(f"the folder {str(path.parent)!r} holds no policy.json, so it is no run folder")
    if not path.exists():
        raise PolicyFileError(f"there is no {str(path)!r}; a policy is a run folder or its policy.json")
    if path.suffix not in (".json", ".safetensors"):
        kind = _foreign_kind(path)
        raise PolicyFileError(
            f"{str(path)!r} is {kind}; only policy.json with policy.safetensors, as train.py writes them, is loaded"
        )
    card, weights = path.with_suffix(".json"), path.with_suffix(".safetensors")
    for file in (card, weights):
        if not file.exists():
            raise PolicyFileError(f"{str(file)!r} is missing beside {path.name}")
    return card, weights


def _foreign_kind(path: Path) -> str:
    """What a file that is not ours seems to be."""
    start = _read(path)[:2]
    if start == b"PK":
        return "a zip, probably of Stable-Baselines3, which can run code when it is opened"
    if start[:1] == b"\x80":
        return "a pickle, which can run code when it is opened"
    return "not a policy file"


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise PolicyFileError(f"cannot read {str(path)!r}: {error.strerror}") from None


def _read_card(path: Path) -> PolicyCard:
    try:
        content = json.loads(_read(path))
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError):
        raise PolicyFileError(f"{str(path)!r} is truncated or no JSON") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise PolicyFileError(f"{str(path)!r} does not describe a policy: its 'format' should be {FORMAT!r}")
    if content.get("version") not in (1, VERSION):
        raise PolicyFileError(
            f"{str(path)!r} is of format version {content.get('version')!r}, but this Lidarena reads 1 to {VERSION}"
        )
    try:
        return PolicyCard.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        raise PolicyFileError(f"{str(path)!r} is damaged at {key!r}: {first['msg']}") from None
