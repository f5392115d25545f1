import ast
import json
import os
import random
import sys
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

import lidarena.agents
from lidarena.agents import load, load_config, train
from lidarena.agents.learners import first_world_seed
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError
from tests.agents.fake_batch import RestorableLineBatch
from tests.agents.training_cases import SMALL, curve, equal, small, weights

SUFFIXES = {".yaml", ".json", ".safetensors", ".csv", ".npz"}


def test_a_run_folder_holds_everything(tmp_path: Path) -> None:
    folder = train(small(tmp_path / "run"), progress=False)
    assert folder == tmp_path / "run"
    names = {path.name for path in folder.iterdir()}
    assert {"config.yaml", "policy.json", "policy.safetensors", "progress.csv", "checkpoints"} < names
    assert load_config(folder / "config.yaml", TrainingConfig) == small(tmp_path / "run")
    policy = load(folder)
    policy.reset(seed=0)
    assert policy.act(np.zeros(3, np.float32), {}) in (0, 1, 2)
    assert policy.training["steps"] == 512 and policy.training["seed"] == 0 and policy.training["episodes"] > 0
    assert [path.name for path in (folder / "checkpoints").iterdir()] == ["step_0000000000512"]


def test_a_dictionary_is_a_configuration_too(tmp_path: Path) -> None:
    folder = train({**SMALL, "out": str(tmp_path / "run")}, progress=False)
    assert load_config(folder / "config.yaml", TrainingConfig) == small(tmp_path / "run")
    with pytest.raises(ConfigError, match=r"'num_env'.*'num_envs'"):
        train({**SMALL, "num_env": 4})


def test_the_learning_curve_has_a_row_an_update(tmp_path: Path) -> None:
    folder = train(small(tmp_path / "run", "normalize_reward=true"), progress=False)
    rows = curve(folder)
    assert [int(row["step"]) for row in rows] == list(range(64, 513, 64))
    last = rows[-1]
    assert 0 <= float(last["completeness"]) <= 1 and 0 <= float(last["collision_rate"]) <= 1
    assert -200 < float(last["episode_return"]) < 100 and 1 <= float(last["episode_length"]) <= 20
    assert all(last[key] for key in ("value_loss", "policy_loss", "entropy_loss", "approx_kl", "learning_rate"))
    events = EventAccumulator(str(folder)).Reload()
    steps = [event.step for event in events.Scalars("rollout/completeness")]
    assert steps == [int(row["step"]) for row in rows if row["completeness"]]
    assert {"rollout/ep_rew_mean", "rollout/collision_rate", "time/steps_per_second", "train/value_loss"} <= set(
        events.Tags()["scalars"]
    )


def test_training_teaches(tmp_path: Path) -> None:
    overrides = ("num_envs=16", "total_steps=4096", "ppo={n_steps: 16, batch_size: 128, learning_rate: 1e-2}")
    folder = train(
        small(tmp_path / "run", "checkpoint_every=4096", "normalize_reward=true", *overrides), progress=False
    )
    policy = load(folder)
    observations = np.random.default_rng(0).uniform(0.2, 0.9, (50, 3)).astype(np.float32)
    actions = [policy.act(observation) for observation in observations]
    assert np.mean(np.array(actions) == 1) > 0.8


def test_the_same_seed_gives_the_same_bits(tmp_path: Path) -> None:
    runs = [train(small(tmp_path / name, "total_steps=128", *more), progress=False) for name, *more in [["a"], ["b"]]]
    other = train(small(tmp_path / "c", "total_steps=128", "seed=1"), progress=False)
    assert equal(weights(runs[0]), weights(runs[1])) and curve(runs[0]) == curve(runs[1])
    assert not equal(weights(runs[0]), weights(other))


def test_settings_reach_ppo(tmp_path: Path) -> None:
    overrides = ("total_steps=64", "ppo.learning_rate={start: 1e-2}", "policy.activation=relu", "torch_threads=2")
    before = torch.get_num_threads()
    folder = train(small(tmp_path / "run", *overrides), progress=False)
    assert torch.get_num_threads() == before
    assert float(curve(folder)[-1]["learning_rate"]) == 0  # the line ends with the last update
    assert json.loads((folder / "policy.json").read_text())["architecture"] == {
        "class": "MlpPolicy",
        "net_arch": [8],
        "activation": "relu",
        "algorithm": "PPO",
        "sizes": {},
    }


def test_worlds_cannot_change_the_threads_of_the_learner(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from stable_baselines3 import PPO

    step, learn, threads = RestorableLineBatch.step, PPO.train, []

    def numba_starts_its_threads(self: RestorableLineBatch, actions: Any) -> Any:
        torch.set_num_threads(2)
        return step(self, actions)

    def count_threads(self: PPO) -> None:
        threads.append(torch.get_num_threads())
        learn(self)

    monkeypatch.setattr(RestorableLineBatch, "step", numba_starts_its_threads)
    monkeypatch.setattr(PPO, "train", count_threads)
    train(small(tmp_path / "run", "total_steps=128"), progress=False)
    assert threads == [1, 1]


def test_dict_observations_are_trained_on(tmp_path: Path) -> None:
    folder = train(small(tmp_path / "run", "total_steps=64", "env.keywords={observation: map}"), progress=False)
    assert json.loads((folder / "policy.json").read_text())["architecture"]["class"] == "MultiInputPolicy"
    observation = {"map": np.zeros((1, 36, 36), np.uint8), "state": np.zeros(3, np.float32)}
    assert load(folder).act(observation) in (0, 1, 2)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("policy=CnnPolicy", "'policy.class' is 'CnnPolicy'.*need 'MlpPolicy'"),
        ("policy=MultiInputPolicy", "need 'MlpPolicy'"),
        ("env.keywords={observation: map}", "need 'MultiInputPolicy'"),
        ("env.keywords={rewrd: x}", "did you mean 'reward'"),
        ("env.id=fakebatch/Nowhere-v0", "no environment 'fakebatch/Nowhere-v0'"),
    ],
)
def test_what_cannot_be_trained_leaves_no_folder(tmp_path: Path, override: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        train(small(tmp_path / "run", "policy=MlpPolicy", override), progress=False)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(torch.cuda.is_available(), reason="there is a CUDA device")
def test_a_missing_device_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="'device' is 'cuda'"):
        train(small(tmp_path / "run", "device=cuda"), progress=False)


def test_a_training_needs_a_configuration() -> None:
    with pytest.raises(ConfigError, match="needs a configuration"):
        train()


def test_nothing_in_a_run_folder_is_a_pickle(tmp_path: Path) -> None:
    folder = train(small(tmp_path / "run", "total_steps=128", "normalize_reward=true"), progress=False)
    for file in (path for path in folder.rglob("*") if path.is_file()):
        assert file.suffix in SUFFIXES or file.name.startswith("events.out.tfevents"), file
        assert file.read_bytes()[:1] != b"\x80"
        if file.suffix == ".npz":
            with np.load(file, allow_pickle=False) as arrays:
                assert all(not arrays[key].dtype.hasobject for key in arrays.files)


def test_the_room_itself_never_imports_pickle() -> None:
    for file in Path(lidarena.agents.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [str(node.module)] if isinstance(node, ast.ImportFrom) else []
            assert not {"pickle", "cloudpickle", "joblib", "dill"} & {name.split(".")[0] for name in names}, file
            assert not (isinstance(node, ast.Attribute) and ast.unparse(node) in ("torch.load", "torch.save")), file


def test_progress_tells_where_the_run_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = train(small(tmp_path / "run", "total_steps=128"))
    output = capsys.readouterr().out
    assert str(folder) in output and "128 of 128 steps (100%)" in output and "completeness" in output


def test_silence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    train(small(tmp_path / "run", "total_steps=64"), progress=False)
    assert capsys.readouterr() == ("", "")


def test_importing_the_room_does_not_import_torch() -> None:
    import subprocess

    code = "import sys, lidarena.agents; from lidarena.agents import load_config; assert 'torch' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).parents[2])
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = lidarena.agents.nonsense
    assert "train" in dir(lidarena.agents)


def test_the_temporary_folder_stays_clean(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import tempfile

    (tmp_path / "tmp").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    train(small(tmp_path / "run", "total_steps=64"), progress=False)
    assert os.listdir(tmp_path / "tmp") == []
    random.seed(0)


def test_trainings_of_neighbouring_seeds_share_no_world() -> None:
    first = [first_world_seed(seed) for seed in range(50)]
    assert min(abs(a - b) for a, b in combinations(first, 2)) > 1000
    assert first == [first_world_seed(seed) for seed in range(50)]
