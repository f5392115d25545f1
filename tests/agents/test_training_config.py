from pathlib import Path
from typing import Any

import pytest

from lidarena.agents.learner_config import Linear
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import check_config, load_config

CONFIGS = Path(__file__).parents[2] / "configs" / "train"


def check(*overrides: str) -> TrainingConfig:
    return check_config({"env": "lidarena/Env1-v0"}, TrainingConfig, overrides)


def test_a_plain_id_and_a_plain_class_are_enough() -> None:
    config = check("policy=CnnPolicy")
    assert (config.env.id, config.env.keywords, config.policy.class_name) == ("lidarena/Env1-v0", {}, "CnnPolicy")


def test_a_value_may_run_in_a_line() -> None:
    config = check("ppo.learning_rate={start: 1e-3}", "ppo.clip_range={start: 0.3, end: 0.1}")
    assert config.ppo.learning_rate == Linear(start=1e-3, end=0)
    assert config.ppo.clip_range == Linear(start=0.3, end=0.1)


@pytest.mark.parametrize(
    ("override", "parts"),
    [
        ("ppo.learnin_rate=1", ["'ppo.learnin_rate'", "did you mean 'learning_rate'?"]),
        ("ppo.learning_rate=0", ["'ppo.learning_rate' is 0", "greater than 0"]),
        ("ppo.learning_rate=true", ["'ppo.learning_rate' is true", "number"]),
        ("ppo.learning_rate={strt: 1}", ["'ppo.learning_rate.strt'", "did you mean 'start'?"]),
        ("ppo.gamma=1.5", ["'ppo.gamma' is 1.5", "less than or equal to 1"]),
        ("ppo.gae_lambda=-0.1", ["'ppo.gae_lambda' is -0.1"]),
        ("ppo.n_steps=0", ["'ppo.n_steps' is 0"]),
        ("ppo.batch_size=100", ["'ppo.batch_size' is 100", "131072", "such as 128"]),
        ("ppo.ent_coef=-1", ["'ppo.ent_coef' is -1"]),
        ("ppo.max_grad_norm=0", ["'ppo.max_grad_norm' is 0"]),
        ("ppo.target_kl=0", ["'ppo.target_kl' is 0"]),
        ("ppo.clip_range=.inf", ["'ppo.clip_range' is inf", "finite"]),
        ("num_envs=0", ["'num_envs' is 0"]),
        ("total_steps=0", ["'total_steps' is 0"]),
        ("total_steps=1.5", ["'total_steps' is 1.5"]),
        ("checkpoint_every=0", ["'checkpoint_every' is 0"]),
        ("seed=-1", ["'seed' is -1"]),
        ("seed=4294967296", ["'seed' is 4294967296"]),
        ("torch_threads=0", ["'torch_threads' is 0"]),
        ("device=tpu", ["'device' is 'tpu'", "Allowed: cpu, cuda"]),
        ("policy=MlpPolicyy", ["'policy.class' is 'MlpPolicyy'", "did you mean 'MlpPolicy'?"]),
        ("policy.clas=MlpPolicy", ["'policy.clas'", "did you mean 'class'?"]),
        ("policy.net_arch=[0]", ["'policy.net_arch.0' is 0"]),
        ("policy.net_arch={actor: [64]}", ["'policy.net_arch' is {'actor'", "PPO takes {pi: […], vf: […]} or a list"]),
        ("policy.activation=tanhh", ["'policy.activation' is 'tanhh'", "did you mean 'tanh'?"]),
        ("env={id: a, keywrds: {}}", ["'env.keywrds'", "did you mean 'keywords'?"]),
        ("env={id: a, keywords: {num_envs: 3}}", ["'env.keywords'", "'num_envs'"]),
        ("env=", ["'env' is empty"]),
        ("out=", ["'out' is empty"]),
        ("out=''", ["'out' is ''"]),
    ],
)
def test_mistakes_are_named(override: str, parts: list[str]) -> None:
    with pytest.raises(ConfigError) as refusal:
        check(override)
    assert all(part in str(refusal.value) for part in parts), refusal.value


def test_the_batch_size_for_one_step_cannot_be_proposed() -> None:
    with pytest.raises(ConfigError, match=r"n_steps × num_envs = 1$"):
        check("num_envs=1", "ppo.n_steps=1")


def test_a_training_file_without_an_environment_is_refused() -> None:
    with pytest.raises(ConfigError, match="'env' is missing"):
        check_config({}, TrainingConfig)


@pytest.mark.parametrize("file", sorted(CONFIGS.glob("*.yaml")), ids=lambda file: file.stem)
def test_the_training_files_of_the_repository_are_right(file: Path) -> None:
    config = load_config(file, TrainingConfig)
    assert config.out == f"runs/{file.stem}"
    comment: Any = file.read_text().splitlines()[1]
    assert file.name in comment
