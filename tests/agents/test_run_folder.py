"""A run goes on only as what it was, and nothing that it has learned is lost."""

import shutil
from pathlib import Path

import pytest

from lidarena.agents import load_config, train
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError
from tests.agents.training_cases import curve, equal, small, weights


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("ppo.n_steps=32", r"trained with ppo.n_steps = 16, so it cannot go on with 32; only total_steps, "),
        ("seed=1", "seed = 0"),
        ("env.keywords={noise: 0.1}", "env.keywords"),
        ("policy.net_arch=[9]", "policy.net_arch"),
        ("ppo.learning_rate={start: 1e-3}", "ppo.learning_rate"),
        ("num_envs=8", "num_envs = 4"),
        ("normalize_reward=true", "normalize_reward = False"),
    ],
)
def test_another_configuration_is_refused(run: Path, override: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        train(small(run, "total_steps=256", override), resume=run, progress=False)


def test_a_training_may_end_with_another_entropy_bonus(run: Path) -> None:
    train(small(run, "total_steps=256", "ppo.ent_coef=0.5"), resume=run, progress=False)
    assert curve(run)[-1]["step"] == "256"
    assert load_config(run / "config.yaml", TrainingConfig).ppo.ent_coef == 0.5


def test_folders_that_are_no_run(tmp_path: Path, run: Path) -> None:
    with pytest.raises(ConfigError, match=r"no run folder .*nowhere"):
        train(resume=tmp_path / "nowhere")
    with pytest.raises(ConfigError, match=r"lacks config.yaml"):
        train(resume=tmp_path)


def test_a_training_killed_before_its_first_checkpoint_begins_anew(tmp_path: Path, run: Path) -> None:
    straight = train(small(tmp_path / "straight"), progress=False)
    shutil.rmtree(run / "checkpoints")
    learned, rows = (run / "policy.safetensors").read_bytes(), (run / "progress.csv").read_bytes()
    again = train(small(run), resume=run, progress=False)
    assert equal(weights(again), weights(straight)) and curve(again) == curve(straight)
    aside = run / "before_1"  # what it had learned before is not lost
    assert (aside / "policy.safetensors").read_bytes() == learned and (aside / "progress.csv").read_bytes() == rows


def test_a_folder_that_is_taken_is_left_alone(tmp_path: Path) -> None:
    config = small(tmp_path / "run", "total_steps=64")
    first = train(config, progress=False)
    before = {path: path.stat().st_mtime_ns for path in first.rglob("*")}
    assert train(config, progress=False) == tmp_path / "run-2"
    assert train(config, progress=False) == tmp_path / "run-3"
    assert load_config(tmp_path / "run-2" / "config.yaml", TrainingConfig).out == str(tmp_path / "run-2")
    with pytest.raises(ConfigError, match=r"already holds files; choose another one, or go on with --resume"):
        train(config, progress=False, exact_out=True)
    assert {path: path.stat().st_mtime_ns for path in first.rglob("*")} == before


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    assert train(small(tmp_path / "run", "total_steps=64"), progress=False, exact_out=True) == tmp_path / "run"


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="cannot make the run folder"):
        train(small(tmp_path / "file" / "run", "total_steps=64"), progress=False)
