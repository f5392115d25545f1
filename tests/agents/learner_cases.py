"""A small training of every algorithm."""

from pathlib import Path

from lidarena.agents.training_config import TrainingConfig
from lidarena.base.yaml_config import check_config
from tests.agents.fake_batch import ID

MASKED = "tests.agents.fake_batch:fakebatch/Masked-v0"


CONTINUOUS = "env.keywords={action: continuous}"


ROLLOUT = "{n_steps: 16, batch_size: 32, n_epochs: 2}"


MEMORY = "buffer_size: 200, learning_starts: 30, batch_size: 16"


CASES = {
    "MaskablePPO": (f"env.id={MASKED}", f"maskable_ppo={ROLLOUT}"),
    "RecurrentPPO": ("recurrent_ppo={n_steps: 16, batch_size: 32, n_epochs: 2, lstm_hidden_size: 8}",),
    "QRDQN": (f"qrdqn={{{MEMORY}, train_freq: 2, n_quantiles: 8, target_update_interval: 20}}",),
    "SAC": (CONTINUOUS, f"sac={{{MEMORY}}}"),
    "TQC": (CONTINUOUS, f"tqc={{{MEMORY}, n_quantiles: 5, ent_coef: 0.1}}"),
}


def small(out: Path, algorithm: str, *overrides: str) -> TrainingConfig:
    content = {"env": {"id": ID}, "algorithm": algorithm, "num_envs": 4, "checkpoint_every": 1000, "out": str(out)}
    case = ("total_steps=256", "policy.net_arch=[8]", *CASES[algorithm], *overrides)
    return check_config(content, TrainingConfig, case)
