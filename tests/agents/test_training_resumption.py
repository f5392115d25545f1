import json
from pathlib import Path

import pytest
import yaml
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from lidarena.agents import TrainingStopped, train
from lidarena.agents.run_folder import config_of
from tests.agents.training_cases import curve, equal, press_ctrl_c, small, stopped_and_resumed, weights

CASES = [
    (),
    ("normalize_reward=true", "ppo.learning_rate={start: 1e-2, end: 1e-3}", "ppo.clip_range={start: 0.3}"),
    ("env.keywords={action: continuous}", "policy.activation=relu"),
    ("env.keywords={observation: map}", "total_steps=256"),
    ("total_steps=500", "checkpoint_every=100"),
]


@pytest.mark.parametrize("overrides", CASES)
def test_a_stopped_training_goes_on_to_the_bit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, overrides: tuple[str, ...]
) -> None:
    resumed, straight = stopped_and_resumed(tmp_path, monkeypatch, overrides)
    assert equal(weights(resumed), weights(straight))
    assert curve(resumed) == curve(straight)
    assert (resumed / "policy.safetensors").read_bytes() == (straight / "policy.safetensors").read_bytes()


def test_a_killed_training_goes_on_from_its_last_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    straight = train(small(tmp_path / "straight"), progress=False)
    with monkeypatch.context() as patch:
        press_ctrl_c(patch, at_step=350, times=2)
        with pytest.raises(TrainingStopped, match=r"from step \d+"):
            train(small(tmp_path / "killed"), progress=False)
    with (tmp_path / "killed" / "progress.csv").open("a") as stream:
        stream.write("38")  # the row that was being written
    resumed = train(resume=tmp_path / "killed", progress=False)
    assert equal(weights(resumed), weights(straight)) and curve(resumed) == curve(straight)
    steps = [event.step for event in EventAccumulator(str(resumed)).Reload().Scalars("train/value_loss")]
    assert steps == [int(row["step"]) for row in curve(straight)]


def test_a_finished_training_can_be_prolonged(tmp_path: Path) -> None:
    straight = train(small(tmp_path / "straight"), progress=False)
    short = train(small(tmp_path / "short", "total_steps=256"), progress=False)
    longer = train(small(short, "checkpoint_every=256"), resume=short, progress=False)
    assert longer == short and equal(weights(longer), weights(straight))


def test_a_finished_training_is_left_as_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = train(small(tmp_path / "run", "total_steps=128"), progress=False)
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*")}
    assert train(resume=folder) == folder
    assert "already has its 128 steps" in capsys.readouterr().out
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*")} == before


def test_a_run_of_version_0_1_goes_on_with_the_observations_that_it_had(tmp_path: Path) -> None:
    keywords = "{particles: 5, max_episode_steps: 20, reward: d_optimality, observation: da_slam_entropy}"
    overrides = ("env.id=lidarena/Env1-v0", f"env.keywords={keywords}", "num_envs=2")
    straight = train(small(tmp_path / "straight", *overrides, "total_steps=96"), progress=False)
    old = train(small(tmp_path / "old", *overrides, "total_steps=32"), progress=False)
    content = yaml.safe_load((old / "config.yaml").read_text())
    del content["algorithm"], content["normalize_observation"], content["env"]["keywords"]["observation"]
    (old / "config.yaml").write_text(yaml.safe_dump(content))
    about = next((old / "checkpoints").rglob("trainer.json"))
    saved = json.loads(about.read_text())
    del saved["made_with"]["env.keywords.observation"]
    about.write_text(json.dumps({**saved, "version": 3}))
    with pytest.warns(DeprecationWarning, match="da_slam_entropy"):
        config = config_of(old, ["total_steps=96"])
    with pytest.warns(DeprecationWarning, match="da_slam_entropy"):
        resumed = train(config, resume=old, progress=False)
    assert equal(weights(resumed), weights(straight))
    assert config_of(old) == config  # it is a run of today now


def test_kill_9_at_random_moments_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(Path(__file__).parents[2] / "benchmarks")
    from kills import exact_resumptions

    assert exact_resumptions(kills=1, steps=3072, seed=3, root=tmp_path) == 1
