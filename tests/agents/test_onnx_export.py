"""Agents as ONNX: equal actions in onnxruntime for every algorithm, spaces in the metadata, and what it cannot say."""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from gymnasium import spaces

pytest.importorskip("onnxruntime", reason="needs onnxruntime, onnx and onnxscript, which lidarena[onnx] installs")
pytest.importorskip("onnxscript")
import onnx
import onnxruntime

from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.agents.networks import Architecture, rebuild
from lidarena.agents.observation_normalizer import ObservationNormalizer
from lidarena.agents.onnx_export import CELL, HIDDEN, MASK, ActionNetwork, export_onnx, sample_inputs
from lidarena.agents.policy_file import read_policy
from lidarena.base.errors import ConfigError, PolicyFileError

PLAIN = spaces.Box(-2.0, 2.0, (6,), np.float32)
KEYS = spaces.Dict({"scan": PLAIN, "picture": spaces.Box(0, 255, (1, 40, 40), np.uint8)})
BOX = spaces.Box(np.float32([-1.0, 0.0]), np.float32([1.0, 3.0]))
KINDS: list[tuple[str, str, spaces.Space[Any], spaces.Space[Any], dict[str, Any]]] = [
    ("PPO", "MlpPolicy", PLAIN, spaces.Discrete(4), {}),
    ("PPO", "MlpPolicy", PLAIN, BOX, {}),
    ("PPO", "MlpPolicy", PLAIN, spaces.MultiDiscrete([2, 3]), {}),
    ("PPO", "MlpPolicy", PLAIN, spaces.MultiBinary(3), {}),
    ("PPO", "MultiInputPolicy", KEYS, spaces.Discrete(3), {}),
    ("MaskablePPO", "MlpPolicy", PLAIN, spaces.Discrete(5), {}),
    ("RecurrentPPO", "MlpPolicy", PLAIN, spaces.Discrete(3), {"lstm_hidden_size": 8, "n_lstm_layers": 1}),
    ("QRDQN", "MlpPolicy", PLAIN, spaces.Discrete(4), {"n_quantiles": 5}),
    ("SAC", "MlpPolicy", PLAIN, BOX, {"n_critics": 2}),
]


def agent(
    algorithm: str, kind: str, seen: spaces.Space[Any], acted: spaces.Space[Any], sizes: dict[str, Any]
) -> LearnedPolicy:
    torch.manual_seed(0)
    if algorithm == "RecurrentPPO":
        sizes = {**sizes, "shared_lstm": False, "enable_critic_lstm": True}
    described = {"algorithm": algorithm, "class": kind, "net_arch": [16], "activation": "tanh", "sizes": sizes}
    network = rebuild(Architecture.model_validate(described), seen, acted)
    with torch.no_grad():
        for weights in network.parameters():  # a fresh network hardly prefers any action
            weights.normal_(0.0, 0.5)
    key = "scan" if isinstance(seen, spaces.Dict) else ""
    statistics = ObservationNormalizer({key: np.full(6, 0.1)}, {key: np.linspace(0.5, 2.0, 6)})
    return LearnedPolicy(network, "lidarena/Arena-v0", {"action": "x"}, {"steps": 7}, normalizer=statistics)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: f"{kind[0]} {type(kind[2]).__name__} {type(kind[3]).__name__}")
def test_actions_are_equal(kind: Any, tmp_path: Path) -> None:
    policy = agent(*kind)
    session = onnxruntime.InferenceSession(str(export_onnx(policy, tmp_path / "a.onnx")))
    model, rng = ActionNetwork(policy), np.random.default_rng(1)
    chosen = set()
    for _ in range(25):
        inputs = sample_inputs(model, rng)
        inputs = {name: np.zeros_like(value) if name in (HIDDEN, CELL) else value for name, value in inputs.items()}
        policy.reset()
        observation = (
            {key: inputs[key][0] for key in kind[2].spaces}
            if isinstance(kind[2], spaces.Dict)
            else inputs["observation"][0]
        )
        expected = policy.act(observation, {"action_mask": inputs[MASK][0]} if MASK in inputs else None)
        given = session.run(None, inputs)[0][0]
        assert np.allclose(given, expected, atol=1e-5)
        chosen.add(str(np.round(given, 2)))
    assert len(chosen) > 1


def test_a_memory_is_handed_on_from_step_to_step(tmp_path: Path) -> None:
    policy = agent(*KINDS[6])
    session = onnxruntime.InferenceSession(str(export_onnx(policy, tmp_path / "a.onnx")))
    model, rng = ActionNetwork(policy), np.random.default_rng(2)
    policy.reset()
    memory = {name: np.zeros_like(sample_inputs(model, rng)[name]) for name in (HIDDEN, CELL)}
    for _ in range(10):
        observation = rng.uniform(-2, 2, 6).astype(np.float32)
        action, hidden, cell = session.run(None, {"observation": observation[None], **memory})
        memory = {HIDDEN: hidden, CELL: cell}
        assert action[0] == policy.act(observation)
    assert np.abs(hidden).max() > 0.1


@pytest.mark.parametrize("name", ["arena", "combined", "low_level"])
def test_shipped_agents(name: str, tmp_path: Path) -> None:
    policy = read_policy(f"pretrained:{name}")
    file = export_onnx(policy, tmp_path / "a.onnx")
    session, model = onnxruntime.InferenceSession(str(file)), ActionNetwork(policy)
    rng = np.random.default_rng(3)
    for _ in range(10):
        observation = sample_inputs(model, rng)["observation"]
        assert np.allclose(session.run(None, {"observation": observation})[0][0], policy.act(observation[0]), atol=1e-5)
    told = {one.key: one.value for one in onnx.load(str(file)).metadata_props}
    assert json.loads(told["env"])["id"] == policy.env_id
    assert json.loads(told["observation_space"])["shape"] == list(policy.observation_space.shape or ())
    assert json.loads(told["action_space"])["type"] == type(policy.action_space).__name__


class Odd(torch.nn.Module):
    """A layer that ONNX has no word for."""

    def forward(self, features: torch.Tensor) -> torch.Tensor:
        return torch.linalg.eigvals(features.T @ features).real[:16].unsqueeze(0).float()


def test_a_layer_that_cannot_be_expressed_is_named(tmp_path: Path) -> None:
    policy = agent(*KINDS[0])
    network: Any = policy.network
    network.mlp_extractor.policy_net[1] = Odd()
    with pytest.raises(PolicyFileError, match=r"layer 'mlp_extractor.policy_net.1' \(Odd\)"):
        export_onnx(policy, tmp_path / "a.onnx")
    assert list(tmp_path.iterdir()) == []


def test_without_onnx_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "onnx", None)
    with pytest.raises(ConfigError, match=r"pip install 'lidarena\[onnx\]'"):
        export_onnx(agent(*KINDS[0]), tmp_path / "a.onnx")
