"""What happens between updates: checkpoints, and how a training is stopped."""

import signal
from pathlib import Path
from typing import Any

import pytest
import torch

from lidarena.agents import TrainingStopped, load, train
from lidarena.base.errors import ConfigError
from lidarena.base.files import write_folder
from tests.agents.training_cases import equal, press_ctrl_c, small, weights


def test_weights_that_leave_the_finite_numbers_do_not_replace_good_ones(tmp_path: Path, monkeypatch: Any) -> None:
    from stable_baselines3 import PPO

    learn = PPO.train

    def explode(self: PPO) -> None:
        learn(self)
        if self.num_timesteps >= 192:
            with torch.no_grad():
                self.policy.value_net.weight.fill_(float("inf"))

    monkeypatch.setattr(PPO, "train", explode)
    with pytest.raises(ConfigError, match=r"failed at step 192: the weights are no longer finite.*learning_rate"):
        train(small(tmp_path / "run"), progress=False)
    assert load(tmp_path / "run").training["steps"] == 128


def test_a_full_disk_leaves_the_last_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[Any] = []

    def full(folder: Path, fill: Any) -> Path:
        calls.append(folder)
        if len(calls) > 1:
            raise OSError(28, "No space left on device")
        return write_folder(folder, fill)

    monkeypatch.setattr("lidarena.agents.checkpoint.write_folder", full)
    with pytest.raises(OSError, match="No space left"):
        train(small(tmp_path / "run"), progress=False)
    monkeypatch.undo()
    folder = train(resume=tmp_path / "run", progress=False)
    assert equal(weights(folder), weights(train(small(tmp_path / "straight"), progress=False)))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_the_training_after_the_update(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], number: int
) -> None:
    before = signal.getsignal(number)
    press_ctrl_c(monkeypatch, at_step=200, number=number)
    with pytest.raises(TrainingStopped, match=r"stopped at step 256; .*lidarena train --resume") as stopped:
        train(small(tmp_path / "run", "checkpoint_every=10_000"))
    assert "once more to stop at once" in capsys.readouterr().err
    assert (stopped.value.folder, stopped.value.step) == (tmp_path / "run", 256)
    assert load(tmp_path / "run").training["steps"] == 256
    assert [path.name for path in (tmp_path / "run" / "checkpoints").iterdir()] == ["step_0000000000256"]
    assert signal.getsignal(number) is before


@pytest.mark.parametrize("inherited", [signal.default_int_handler, signal.SIG_IGN])
def test_ctrl_c_twice_ends_it_at_once_and_keeps_the_policy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, inherited: Any, request: pytest.FixtureRequest
) -> None:
    before = signal.signal(signal.SIGINT, inherited)  # shells start programs in the background with Ctrl-C ignored
    request.addfinalizer(lambda: signal.signal(signal.SIGINT, before))
    press_ctrl_c(monkeypatch, at_step=300, times=2)
    with pytest.raises(TrainingStopped, match=r"to go on from step \d+"):
        train(small(tmp_path / "run"))
    assert load(tmp_path / "run").training["steps"] >= 300
    press_ctrl_c(monkeypatch, at_step=10, times=2)
    with pytest.raises(TrainingStopped, match="it had no checkpoint yet"):
        train(small(tmp_path / "early"))
    assert load(tmp_path / "early").training["steps"] < 64
    assert signal.getsignal(signal.SIGINT) is inherited


def test_training_works_outside_the_main_thread(tmp_path: Path) -> None:
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(train, small(tmp_path / "run", "total_steps=64"), None, False).result() == tmp_path / "run"
