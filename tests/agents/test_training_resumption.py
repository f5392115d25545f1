import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from lidarena.agents import TrainingStopped, checkpoint, train
from lidarena.agents.run_folder import config_of
from lidarena.base.errors import ConfigError
from tests.agents.training_cases import curve, equal, press_ctrl_c, small, weights

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
    straight = train(small(tmp_path / "straight", *overrides), progress=False)
    with monkeypatch.context() as patch:
        press_ctrl_c(patch, at_step=150)
        with pytest.raises(TrainingStopped):
            train(small(tmp_path / "stopped", *overrides), progress=False)
    np.random.seed(99)  # another process would have other generators
    resumed = train(resume=tmp_path / "stopped", progress=False)
    assert equal(weights(resumed), weights(straight))
    assert curve(resumed) == curve(straight)
    assert (resumed / "policy.safetensors").read_bytes() == (straight / "policy.safetensors").read_bytes()


def test_real_worlds_go_on_to_the_bit(tmp_path: Path) -> None:
    overrides = ("env.id=lidarena/Env1-v0", "env.keywords={particles: 5, max_episode_steps: 20}", "num_envs=2")
    straight = train(small(tmp_path / "straight", *overrides, "total_steps=96"), progress=False)
    stopped = train(small(tmp_path / "stopped", *overrides, "total_steps=32"), progress=False)
    resumed = train(small(stopped, *overrides, "total_steps=96"), resume=stopped, progress=False)
    assert equal(weights(resumed), weights(straight)) and curve(resumed) == curve(straight)
    assert curve(resumed)[-1]["completeness"]


def test_arenas_go_on_to_the_bit(tmp_path: Path) -> None:
    keywords = "env.keywords={arena: random, arenas: 5, action: discrete, max_episode_steps: 12}"
    overrides = ("env.id=lidarena/Arena-v0", keywords, "num_envs=3", "ppo.batch_size=16")
    straight = train(small(tmp_path / "straight", *overrides, "total_steps=144"), progress=False)
    stopped = train(small(tmp_path / "stopped", *overrides, "total_steps=48"), progress=False)
    resumed = train(small(stopped, *overrides, "total_steps=144"), resume=stopped, progress=False)
    assert equal(weights(resumed), weights(straight)) and curve(resumed) == curve(straight)
    assert curve(resumed)[-1]["success_rate"] == "0" and not curve(resumed)[-1]["completeness"]


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


def test_worlds_that_cannot_be_written_down_start_over(tmp_path: Path) -> None:
    config = small(tmp_path / "run", "env.id=fakebatch/Stranger-v0", "total_steps=128")
    folder = train(config, progress=False)
    train(resume=folder, config=config.model_copy(update={"total_steps": 256}), progress=False)
    assert [int(row["step"]) for row in curve(folder)] == [64, 128, 192, 256]


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


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return train(small(tmp_path_factory.mktemp("finished") / "run", "total_steps=128"), progress=False)


@pytest.fixture
def run(finished: Path, tmp_path: Path) -> Path:
    """A run that a test may damage; a longer `total_steps` lets it go on."""
    return Path(shutil.copytree(finished, tmp_path / "run"))


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


@pytest.mark.parametrize("name", ["model.safetensors", "worlds.npz", "trainer.npz", "trainer.json"])
def test_a_missing_file_is_named(run: Path, name: str) -> None:
    (run / "checkpoints" / "step_0000000000128" / name).unlink()
    with pytest.raises(ConfigError, match=f"lacks {name}"):
        train(small(run, "total_steps=256"), resume=run, progress=False)


@pytest.mark.parametrize("name", ["model.safetensors", "worlds.npz", "trainer.npz", "trainer.json"])
@pytest.mark.parametrize("share", [0.0, 0.5, 0.99])
def test_a_truncated_file_is_refused(run: Path, name: str, share: float) -> None:
    file = run / "checkpoints" / "step_0000000000128" / name
    file.write_bytes(file.read_bytes()[: int(share * file.stat().st_size)])
    with pytest.raises(ConfigError, match="is damaged") as refusal:
        train(small(run, "total_steps=256"), resume=run, progress=False)
    assert "\n" not in str(refusal.value)


def test_pickled_arrays_are_never_opened(run: Path) -> None:
    bomb: Any = {"position": np.array([Path("x")], dtype=object)}
    np.savez(run / "checkpoints" / "step_0000000000128" / "worlds.npz", **bomb)
    with pytest.raises(ConfigError, match="is damaged"):
        train(small(run, "total_steps=256"), resume=run, progress=False)


def test_a_checkpoint_of_another_version_is_refused(run: Path) -> None:
    file = run / "checkpoints" / "step_0000000000128" / "trainer.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), "version": 7}))
    with pytest.raises(ConfigError, match="version 7"):
        train(small(run, "total_steps=256"), resume=run, progress=False)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("seed=1", "is of another training, made with seed = 1 where this one has 0"),
        ("env.keywords={noise: 0.1}", "made with env.keywords"),
        ("ppo.learning_rate=5e-4", "made with ppo.learning_rate"),
    ],
)
def test_a_checkpoint_of_another_training_is_refused(run: Path, tmp_path: Path, override: str, message: str) -> None:
    other = train(small(tmp_path / "other", "total_steps=128", override), progress=False)
    shutil.rmtree(run / "checkpoints")
    shutil.copytree(other / "checkpoints", run / "checkpoints")
    with pytest.raises(ConfigError, match=message) as refusal:
        train(small(run, "total_steps=256"), resume=run, progress=False)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("name", ["model.safetensors", "worlds.npz", "trainer.npz"])
def test_a_flipped_bit_is_noticed(run: Path, name: str) -> None:
    file = run / "checkpoints" / "step_0000000000128" / name
    content = bytearray(file.read_bytes())
    content[-9] ^= 1
    file.write_bytes(content)
    with pytest.raises(ConfigError, match=f"is damaged: {name} is not the file that was saved"):
        train(small(run, "total_steps=256"), resume=run, progress=False)


def test_an_older_checkpoint_is_pointed_to_and_other_folders_are_passed_over(run: Path) -> None:
    folder = run / "checkpoints"
    shutil.copytree(folder / "step_0000000000128", folder / "step_0000000000128.bak")
    shutil.copytree(folder / "step_0000000000128", folder / "step_0000000000192")
    (folder / "step_abc").mkdir()
    (folder / "step_0000000000192" / "worlds.npz").unlink()
    with pytest.raises(ConfigError, match=r"lacks worlds.npz.*; without that folder it goes on from step 128$"):
        train(small(run, "total_steps=256"), resume=run, progress=False)
    shutil.rmtree(folder / "step_0000000000192")
    train(small(run, "total_steps=256"), resume=run, progress=False)


def test_a_refused_resumption_changes_nothing(run: Path) -> None:
    (run / "checkpoints" / "step_0000000000128" / "worlds.npz").unlink()
    before = {path: path.stat().st_mtime_ns for path in run.rglob("*")}
    with pytest.raises(ConfigError):
        train(small(run, "total_steps=256"), resume=run, progress=False)
    assert {path: path.stat().st_mtime_ns for path in run.rglob("*")} == before


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


def test_kill_9_at_random_moments_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(Path(__file__).parents[2] / "benchmarks")
    from kills import exact_resumptions

    assert exact_resumptions(kills=1, steps=3072, seed=3, root=tmp_path) == 1


def test_a_checkpoint_that_was_being_written_does_not_count(run: Path) -> None:
    (run / "checkpoints" / ".step_0000000000192.1.part").mkdir()
    assert checkpoint.newest(run) == run / "checkpoints" / "step_0000000000128"


def test_worlds_with_python_objects_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.agents.fake_batch import RestorableLineBatch

    monkeypatch.setattr(RestorableLineBatch, "get_state", lambda self: {"worlds": np.array([{}], dtype=object)})
    with pytest.raises(TypeError, match="'worlds' holds Python objects"):
        train(small(tmp_path / "run"), progress=False)
    assert not list((tmp_path / "run").rglob("step_*"))
