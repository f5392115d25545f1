"""A trained agent as an ONNX file: from an observation, as the environment gives it, to the agent's best action.

The file holds normalization, network and choice, so that a robot needs nothing but a runtime for ONNX. Its metadata
hold the environment and the spaces as the policy file describes them. onnx and onnxscript come with ``lidarena[onnx]``.
"""

import json
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from torch import nn

from lidarena.agents import space_json
from lidarena.agents.acting import is_recurrent, is_squashed, wants_masks
from lidarena.agents.candidate_policy import CandidateScores
from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.agents.observation_normalizer import CLIP, EPSILON, ObservationNormalizer
from lidarena.base.errors import ConfigError, PolicyFileError
from lidarena.base.files import write_bytes

MASK, HIDDEN, CELL, ACTION = "action_mask", "hidden", "cell", "action"
"""Names of inputs and outputs beside ``observation`` (or a dictionary's keys): a mask of allowed actions, and what a
recurrent network remembers: zeros when an episode begins, then what came out as ``next_hidden``, ``next_cell``."""
_OPSET = 18
_RULED_OUT = -1e8


class ActionNetwork(nn.Module):
    """Observation in, action out, for a batch of one; what ``LearnedPolicy.act`` does when it is deterministic."""

    def __init__(self, policy: LearnedPolicy) -> None:
        super().__init__()
        self.network = policy.network
        self.observation_space, self.action_space = policy.observation_space, policy.action_space
        self.masked, self.recurrent = wants_masks(policy.network), is_recurrent(policy.network)
        self.scaled = _statistics(policy.normalizer)
        for name, array in self.scaled.items():
            self.register_buffer(name.replace(".", "_dot_"), array)

    @property
    def input_names(self) -> list[str]:
        """In the order of ``forward``."""
        space = self.observation_space
        own = list(space.spaces) if isinstance(space, spaces.Dict) else ["observation"]
        return [*own, *([MASK] if self.masked else []), *([HIDDEN, CELL] if self.recurrent else [])]

    @property
    def output_names(self) -> list[str]:
        """In the order of what ``forward`` returns."""
        return [ACTION, *([f"next_{HIDDEN}", f"next_{CELL}"] if self.recurrent else [])]

    def forward(self, *given: torch.Tensor) -> tuple[torch.Tensor, ...]:
        """Return the action, and of a recurrent network its memory."""
        parts = list(given)
        memory = (parts[-2], parts[-1]) if self.recurrent else None
        parts = parts[:-2] if self.recurrent else parts
        mask = parts.pop() if self.masked else None
        if isinstance(self.observation_space, spaces.Dict):
            observation: Any = {
                key: self._normalized(key, part) for key, part in zip(self.observation_space.spaces, parts, strict=True)
            }
        else:
            observation = self._normalized("", parts[0])
        values, memory = self._values(observation, memory)
        return (self._action(values, mask), *(memory or ()))

    def _normalized(self, key: str, values: torch.Tensor) -> torch.Tensor:
        if f"mean.{key}" not in self.scaled:
            return values
        mean, variance = (getattr(self, f"{what}_dot_{key}") for what in ("mean", "variance"))
        scaled = (values.double() - mean) / torch.sqrt(variance + EPSILON)
        return torch.clamp(scaled, -CLIP, CLIP).float()

    def _values(self, observation: Any, memory: Any) -> tuple[torch.Tensor, Any]:
        own: Any = self.network
        if hasattr(own, "quantile_net"):
            return own.quantile_net(observation).mean(dim=1), None
        if is_squashed(own):
            return own.actor.get_action_dist_params(observation)[0], None
        features = own.extract_features(observation, own.pi_features_extractor)
        if memory is not None:
            latent, memory = own.lstm_actor(features.unsqueeze(0), memory)
            features = latent.squeeze(0)
        return own.action_net(own.mlp_extractor.forward_actor(features)), memory

    def _action(self, values: torch.Tensor, mask: torch.Tensor | None) -> torch.Tensor:
        space = self.action_space
        if mask is not None:
            values = torch.where(mask, values, torch.full_like(values, _RULED_OUT))
        if isinstance(space, spaces.Discrete):
            return values.argmax(dim=1)
        if isinstance(space, spaces.MultiDiscrete):
            parts = torch.split(values, space.nvec.ravel().tolist(), dim=1)
            return torch.stack([part.argmax(dim=1) for part in parts], dim=1)
        if isinstance(space, spaces.MultiBinary):
            if mask is not None:
                return values.reshape(len(values), -1, 2).argmax(dim=2)
            return (values > 0).long()
        assert isinstance(space, spaces.Box)
        low, high = torch.as_tensor(space.low).ravel(), torch.as_tensor(space.high).ravel()
        if is_squashed(self.network):
            values = low + 0.5 * (torch.tanh(values) + 1.0) * (high - low)
        return torch.minimum(torch.maximum(values, low), high).reshape(len(values), *space.shape)


def _statistics(normalizer: ObservationNormalizer | None) -> dict[str, torch.Tensor]:
    """Means and variances of the observation's parts, as ``mean.KEY`` and ``variance.KEY``."""
    if normalizer is None:
        return {}
    return {name.partition(".")[2]: tensor for name, tensor in normalizer.tensors().items()}


def sample_inputs(model: ActionNetwork, rng: np.random.Generator) -> dict[str, np.ndarray[Any, Any]]:
    """Return random inputs by name, as a runtime takes them: a batch of one."""
    space = model.observation_space
    parts = space.spaces if isinstance(space, spaces.Dict) else {"observation": space}
    found = {name: _sample(part, rng) for name, part in parts.items()}
    if model.masked:
        allowed = rng.random((1, _choices(model.action_space))) < 0.7
        allowed[:, 0] = True
        found[MASK] = allowed
    if model.recurrent:
        network: Any = model.network
        shape = network.lstm_hidden_state_shape
        found |= {name: rng.normal(size=shape).astype(np.float32) for name in (HIDDEN, CELL)}
    return found


def _sample(space: spaces.Space[Any], rng: np.random.Generator) -> np.ndarray[Any, Any]:
    if not isinstance(space, spaces.Box):
        raise PolicyFileError(f"an observation of {space} cannot be an input of ONNX here; a Box is needed")
    if np.issubdtype(space.dtype, np.integer):
        return rng.integers(space.low, space.high, endpoint=True, size=space.shape)[None].astype(space.dtype)
    low, high = np.clip(space.low, -5, 5), np.clip(space.high, -5, 5)
    return rng.uniform(low, high)[None].astype(np.float32)


def _choices(space: spaces.Space[Any]) -> int:
    """Logits of an action space that masks can be for."""
    if isinstance(space, spaces.Discrete):
        return int(space.n)
    return int(space.nvec.sum()) if isinstance(space, spaces.MultiDiscrete) else 2 * int(np.prod(space.shape or ()))


def export_onnx(policy: LearnedPolicy, path: str | Path) -> Path:
    """Write an agent as ONNX; the file appears whole or not at all.

    Args:
        policy: The agent, as `lidarena.agents.load` gives it without an environment.
        path: The file.

    Raises:
        ConfigError: onnx or onnxscript is not installed.
        PolicyFileError: ONNX cannot express the network; it says which layer.
        WriteError: The file cannot be written.
    """
    try:
        import onnx
        import onnxscript  # noqa: F401 - torch's exporter asks for it
    except ImportError as error:
        raise ConfigError(f"{error.name} is needed for ONNX; install it with pip install 'lidarena[onnx]'") from None
    model = ActionNetwork(policy).eval()
    inputs = sample_inputs(model, np.random.default_rng(0))
    tensors = tuple(torch.as_tensor(inputs[name]) for name in model.input_names)
    for module in model.modules():
        if isinstance(module, CandidateScores):
            module.trimmed = False  # which rows are looked at must not depend on the example
    try:
        exported = _exported(model, tensors, model.input_names, model.output_names)
    except Exception as error:
        raise PolicyFileError(_blame(model, tensors, error)) from error
    finally:
        for module in model.modules():
            if isinstance(module, CandidateScores):
                module.trimmed = True
    description = {
        "format": "lidarena-policy",
        "env": {"id": policy.env_id, "keywords": policy.env_keywords},
        "observation_space": space_json.to_json(policy.observation_space),
        "action_space": space_json.to_json(policy.action_space),
        "training": policy.training,
    }
    for key, value in description.items():
        entry = exported.metadata_props.add()
        entry.key, entry.value = key, value if isinstance(value, str) else json.dumps(value)
    onnx.checker.check_model(exported)
    return write_bytes(path, exported.SerializeToString())


def _exported(
    model: nn.Module, tensors: tuple[torch.Tensor, ...], inputs: Sequence[str], outputs: Sequence[str]
) -> Any:
    """The network as torch's exporter tells it."""
    with warnings.catch_warnings(), torch.no_grad():
        warnings.simplefilter("ignore")  # of torch's own future
        program: Any = torch.onnx.export(
            model,
            tensors,
            dynamo=True,
            input_names=list(inputs),
            output_names=list(outputs),
            opset_version=_OPSET,
            verbose=False,
        )
    return program.model_proto


def _blame(model: ActionNetwork, tensors: tuple[torch.Tensor, ...], error: Exception) -> str:
    """Which layer it is that cannot be expressed: the first that cannot be exported by itself."""
    seen: list[tuple[str, nn.Module, tuple[Any, ...]]] = []
    hooks = [
        module.register_forward_hook(lambda one, given, _, name=name: seen.append((name, one, given)))
        for name, module in model.named_modules()
        if name and not list(module.children())
    ]
    try:
        with torch.no_grad():
            model(*tensors)
    finally:
        for hook in hooks:
            hook.remove()
    for name, module, given in seen:
        if all(isinstance(one, torch.Tensor) for one in given):
            try:
                _exported(module, given, [f"input_{k}" for k in range(len(given))], ["output"])
            except Exception:
                kind = type(module).__name__
                return f"ONNX cannot express the layer {name.removeprefix('network.')!r} ({kind}) of the agent"
    reason = next((line for line in str(error).splitlines() if line.strip()), type(error).__name__)
    return f"ONNX cannot express the agent's network ({type(model.network).__name__}): {reason}"
