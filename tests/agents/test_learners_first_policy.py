"""What an untrained policy does, where the training file says so."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

from lidarena.agents.batches import make_batch
from lidarena.agents.learners import make_model
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import check_config
from tests.agents.fake_batch import ID
from tests.agents.learner_cases import CONTINUOUS, small


def model_of(tmp_path: Path, *overrides: str, env: str = ID, **more: Any) -> Any:
    content = {"env": {"id": env}, "num_envs": 4, "out": str(tmp_path / "run"), "policy": {"net_arch": [8]}, **more}
    config = check_config(content, TrainingConfig, overrides)
    return make_model(config, make_batch(config.env, config.num_envs))


def probabilities(model: Any) -> list[np.ndarray]:
    seen = torch.as_tensor(np.random.default_rng(0).uniform(0, 1, (50, 3)), dtype=torch.float32)
    drawn = model.policy.get_distribution(seen).distribution
    parts = drawn if isinstance(drawn, list) else [drawn]
    return [part.probs.detach().numpy() for part in parts]


def test_it_mostly_takes_the_action_that_it_is_to_begin_with(tmp_path: Path) -> None:
    (chances,) = probabilities(model_of(tmp_path, "policy.first_action=2"))
    assert chances[:, 2] == pytest.approx(np.e**2 / (np.e**2 + 2), abs=0.01)
    (even,) = probabilities(model_of(tmp_path))
    assert even == pytest.approx(1 / 3, abs=0.02)


def test_each_of_several_actions_is_preferred() -> None:
    config = {"env": {"id": "lidarena/Seabed-v0", "keywords": {"duration": 2.0}}, "num_envs": 1}
    checked = check_config({**config, "policy": {"first_action": [2, 1]}}, TrainingConfig)
    model: Any = make_model(checked, make_batch(checked.env, 1))
    bias = model.policy.action_net.bias.detach().numpy()
    skips = len(bias) - 3
    assert np.flatnonzero(bias > 1.0).tolist() == [2, skips + 1]


def test_continuous_actions_are_drawn_as_narrowly_as_asked(tmp_path: Path) -> None:
    model = model_of(tmp_path, CONTINUOUS, "policy.log_std_init=-1.5")
    assert model.policy.log_std.detach().numpy() == pytest.approx(-1.5)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (["policy.first_action=3"], "first_action' is 3, but the actions are Discrete"),
        (["policy.first_action=-1"], "first_action' is -1"),
        (["policy.first_action=[0, 1]"], r"first_action' is \[0, 1\]"),
        ([CONTINUOUS, "policy.first_action=0"], "for policies that draw among discrete actions"),
        (
            ["policy.log_std_init=-1"],
            "for continuous actions of PPO or RecurrentPPO, not for PPO with",
        ),
    ],
)
def test_what_the_actions_do_not_have_is_refused(tmp_path: Path, overrides: list[str], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        model_of(tmp_path, *overrides)


@pytest.mark.parametrize(("algorithm", "override"), [("SAC", "log_std_init=-1"), ("QRDQN", "first_action=0")])
def test_learners_without_such_a_policy_refuse(tmp_path: Path, algorithm: str, override: str) -> None:
    config = small(tmp_path / "run", algorithm, f"policy.{override}")
    with pytest.raises(ConfigError, match=f"not for {algorithm} with actions"):
        make_model(config, make_batch(config.env, config.num_envs))
