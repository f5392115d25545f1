"""Checkpoints that are damaged, of another training, or half written are refused in one sentence."""

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lidarena.agents import checkpoint, train
from lidarena.base.errors import ConfigError
from tests.agents.training_cases import small


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


def test_a_checkpoint_that_was_being_written_does_not_count(run: Path) -> None:
    (run / "checkpoints" / ".step_0000000000192.1.part").mkdir()
    assert checkpoint.newest(run) == run / "checkpoints" / "step_0000000000128"


def test_worlds_with_python_objects_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.agents.fake_batch import RestorableLineBatch

    monkeypatch.setattr(RestorableLineBatch, "get_state", lambda self: {"worlds": np.array([{}], dtype=object)})
    with pytest.raises(TypeError, match="'worlds' holds Python objects"):
        train(small(tmp_path / "run"), progress=False)
    assert not list((tmp_path / "run").rglob("step_*"))
