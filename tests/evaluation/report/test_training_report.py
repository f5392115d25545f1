"""The report of a training: what was reached, what is missing, and the agent's episode."""

from pathlib import Path

import pytest

from lidarena.base.errors import ConfigError
from lidarena.evaluation.report.training_report import content_of_training, curves_figure
from tests.evaluation.test_reward_curves import run

CONFIG = "env: {id: lidarena/Env1-v0}\nseed: 3\ntotal_steps: 100\nalgorithm: PPO\n"


def test_the_facts_are_the_last_row_and_the_best(tmp_path: Path) -> None:
    folder = run(tmp_path / "mine", -1.0)
    (folder / "config.yaml").write_text(CONFIG)
    content = content_of_training(folder)
    assert content.facts[0] == "PPO in lidarena/Env1-v0: return -60, explored 50.0% after 60 of 100 steps."
    assert content.facts[1].startswith("The highest return was -20 at step 20.") and "seed (3)" in content.facts[1]
    assert content.players == [] and content.missing == ["there is no policy yet (policy.json)"]
    assert content.details["Configuration"] == CONFIG


def test_a_training_that_has_only_begun(tmp_path: Path) -> None:
    (tmp_path / "config.yaml").write_text(CONFIG)
    content = content_of_training(tmp_path)
    assert "nothing was recorded yet" in content.facts[0] and content.figures == []
    assert any("no learning curve" in sentence for sentence in content.missing)
    (tmp_path / "progress.csv").write_text("step,episode_return\n")
    assert any("has no row yet" in sentence for sentence in content_of_training(tmp_path).missing)


def test_a_policy_that_cannot_drive_costs_its_episode_alone(tmp_path: Path) -> None:
    folder = run(tmp_path / "mine", 1.0)
    (folder / "config.yaml").write_text(CONFIG)
    (folder / "policy.json").write_text('{"format": "something else"}')
    content = content_of_training(folder)
    assert content.players == [] and content.missing[0].startswith("no episode could be driven: ")
    assert content_of_training(folder, episode=False).missing == []


def test_a_configuration_that_is_torn(tmp_path: Path) -> None:
    (tmp_path / "config.yaml").write_text("env: [")
    with pytest.raises(ConfigError, match="is not valid YAML"):
        content_of_training(tmp_path)


def test_curves_are_the_same_text_every_time(tmp_path: Path) -> None:
    folder = run(tmp_path / "mine", 1.0)
    first, second = curves_figure([folder]), curves_figure([folder])
    assert first.kind == "svg" and first.data.startswith(b"<svg") and first == second
