"""Normalized observations: kept in the policy file, applied by the loaded policy, exact in a resumption."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import safetensors.torch
import torch
from gymnasium import spaces

from lidarena.agents import load, train
from lidarena.agents.observation_normalizer import CLIP, ObservationNormalizer, keys_to_normalize
from lidarena.agents.policy_file import read_policy
from lidarena.base.errors import ConfigError, PolicyFileError
from tests.agents.training_cases import curve, equal, small, stopped_and_resumed, weights

ON = "normalize_observation=true"
MEMORY = ("algorithm=SAC", "ppo=", "sac={buffer_size: 300, learning_starts: 30, batch_size: 16}", "total_steps=256")


@pytest.mark.parametrize(
    "overrides",
    [
        (ON,),
        (ON, "normalize_reward=true", "env.keywords={observation: map}", "total_steps=256"),
        (ON, "env.keywords={action: continuous}", *MEMORY),
    ],
)
def test_a_stopped_training_goes_on_to_the_bit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, overrides: tuple[str, ...]
) -> None:
    resumed, straight = stopped_and_resumed(tmp_path, monkeypatch, overrides)
    assert equal(weights(resumed), weights(straight))
    assert (resumed / "policy.safetensors").read_bytes() == (straight / "policy.safetensors").read_bytes()
    assert "algorithm=SAC" in overrides or curve(resumed) == curve(straight)


def test_the_loaded_policy_sees_what_the_learner_saw(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from stable_baselines3.common.vec_env import VecNormalize

    last: list[VecNormalize] = []
    remember = VecNormalize.__init__
    monkeypatch.setattr(VecNormalize, "__init__", lambda self, *a, **k: (last.append(self), remember(self, *a, **k))[1])
    policy = load(train(small(tmp_path / "run", ON), progress=False))
    observations: Any = np.random.default_rng(0).uniform(0, 1, (20, 3)).astype(np.float32)
    assert policy.normalizer is not None
    for observation in observations:
        seen = policy.normalizer.apply(observation)
        assert seen.dtype == np.float32 and np.array_equal(seen, last[0].normalize_obs(observation))
        with torch.no_grad():
            distribution: Any = policy.network.get_distribution(torch.as_tensor(seen[None])).distribution  # type: ignore[operator]
        assert policy.act(observation) == int(distribution.probs.argmax())


def test_numbers_far_out_are_cut_off_and_those_that_never_change_become_0() -> None:
    normalizer = ObservationNormalizer({"": np.array([1.0, 5.0])}, {"": np.array([1e-4, 0.0])})
    assert np.array_equal(normalizer.apply(np.array([100.0, 5.0])), [CLIP, 0])
    assert np.array_equal(normalizer.apply(np.array([-100.0, 5.0])), [-CLIP, 0])


def test_pictures_are_left_alone(tmp_path: Path) -> None:
    folder = train(small(tmp_path / "run", ON, "env.keywords={observation: map}", "total_steps=64"), progress=False)
    names = {name for name in safetensors.torch.load_file(folder / "policy.safetensors") if "normalizer" in name}
    assert names == {"observation_normalizer.mean.state", "observation_normalizer.variance.state"}
    policy = load(folder)
    picture = np.full((1, 36, 36), 7, np.uint8)
    seen = policy.normalizer.apply({"map": picture, "state": np.zeros(3, np.float32)})  # type: ignore[union-attr]
    assert seen["map"] is picture and seen["state"].dtype == np.float32


def test_observations_without_numbers_are_refused() -> None:
    picture, number = spaces.Box(0, 255, (3, 36, 36), np.uint8), spaces.Box(-1, 1, (2,))
    assert keys_to_normalize(number) is None
    assert keys_to_normalize(spaces.Dict({"a": picture, "b": number, "c": spaces.Discrete(3)})) == ["b"]
    for space in (picture, spaces.Discrete(4), spaces.Dict({"a": picture})):
        with pytest.raises(ConfigError, match=r"'normalize_observation' is true, but .* hold no numbers"):
            keys_to_normalize(space)


@pytest.mark.parametrize("damage", ["shape", "name", "half", "infinite"])
def test_statistics_that_do_not_fit_are_refused(tmp_path: Path, damage: str) -> None:
    import hashlib
    import json

    folder = train(small(tmp_path / "run", ON, "total_steps=64"), progress=False)
    tensors = safetensors.torch.load_file(folder / "policy.safetensors")
    mean = "observation_normalizer.mean."
    if damage == "half":
        del tensors[mean]
    else:
        held = tensors.pop(mean)
        replaced = {"shape": held[:2].clone(), "name": held, "infinite": held / 0.0}[damage]
        tensors[mean + "x" if damage == "name" else mean] = replaced
    data = safetensors.torch.save(tensors)
    (folder / "policy.safetensors").write_bytes(data)
    card = json.loads((folder / "policy.json").read_text())
    (folder / "policy.json").write_text(json.dumps(card | {"weights_sha256": hashlib.sha256(data).hexdigest()}))
    with pytest.raises(PolicyFileError, match=r"does not fit policy\.json"):
        read_policy(folder)
