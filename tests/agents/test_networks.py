from pathlib import Path

import pytest

from lidarena.agents import load, train
from lidarena.agents.batches import make_batch
from lidarena.agents.learners import make_model
from lidarena.agents.training_config import EnvironmentConfig, TrainingConfig
from lidarena.base.errors import ConfigError
from tests.agents.fake_batch import ID
from tests.agents.learner_cases import CONTINUOUS, small


@pytest.mark.parametrize(
    ("algorithm", "override", "message"),
    [
        ("SAC", "env.keywords={}", r"takes actions of Box, but .* has Discrete\(3\); allowed here: MaskablePPO, PPO"),
        ("QRDQN", CONTINUOUS, r"takes actions of Discrete, .*; allowed here: PPO, RecurrentPPO, SAC, TQC"),
        ("MaskablePPO", f"env.id={ID}", r"has no action_masks\(\); allowed here: PPO"),
        ("MaskablePPO", "policy=CandidatePolicy", "it is for PPO only"),
        ("SAC", "sac.n_steps=3", None),
        ("QRDQN", "env.keywords={observation: map}", None),
    ],
)
def test_networks_that_cannot_be_are_refused(
    tmp_path: Path, algorithm: str, override: str, message: str | None
) -> None:
    if message is None:
        assert load(train(small(tmp_path / "run", algorithm, override, "total_steps=64"), progress=False))
        return
    with pytest.raises(ConfigError, match=message) as refusal:
        train(small(tmp_path / "run", algorithm, override), progress=False)
    assert "\n" not in str(refusal.value) and not list(tmp_path.iterdir())


def test_actions_that_do_not_begin_at_0_are_refused() -> None:
    env = EnvironmentConfig(id="tests.agents.fake_single:stranger/Walk-v0", keywords={"start": 1})
    with pytest.raises(ConfigError, match="only those that begin at 0"):
        make_model(TrainingConfig(env=env), make_batch(env, 2))
