"""Small trainings for tests: what is trained, what came out, and who presses Ctrl-C."""

import csv
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import safetensors.torch

from lidarena.agents import TrainingConfig, TrainingStopped, train, training_run
from lidarena.base.yaml_config import check_config
from tests.agents.fake_batch import ID

SMALL: dict[str, Any] = {
    "env": {"id": ID},
    "total_steps": 512,
    "num_envs": 4,
    "checkpoint_every": 128,
    "ppo": {"n_steps": 16, "batch_size": 32, "n_epochs": 2},
    "policy": {"net_arch": [8]},
}
CLOCK = ("seconds", "steps_per_second")


def small(out: Path, *overrides: str) -> TrainingConfig:
    return check_config({**SMALL, "out": str(out)}, TrainingConfig, overrides)


def weights(folder: Path) -> dict[str, Any]:
    """Everything that a training has learned, Adam's moments included."""
    last = max((folder / "checkpoints").iterdir())
    return {key: value.numpy() for key, value in safetensors.torch.load_file(last / "model.safetensors").items()}


def stopped_and_resumed(folder: Path, monkeypatch: pytest.MonkeyPatch, overrides: tuple[str, ...]) -> tuple[Path, Path]:
    """A training that is stopped after a while and goes on, and the same one left alone."""
    straight = train(small(folder / "straight", *overrides), progress=False)
    with monkeypatch.context() as patch:
        press_ctrl_c(patch, at_step=150)
        with pytest.raises(TrainingStopped):
            train(small(folder / "stopped", *overrides), progress=False)
    np.random.seed(99)  # another process would have other generators
    return train(resume=folder / "stopped", progress=False), straight


def equal(one: dict[str, Any], other: dict[str, Any]) -> bool:
    return one.keys() == other.keys() and all(np.array_equal(one[key], other[key]) for key in one)


def curve(folder: Path) -> list[dict[str, str]]:
    """Rows of the learning curve without what the clock says."""
    with (folder / "progress.csv").open() as stream:
        return [{key: value for key, value in row.items() if key not in CLOCK} for row in csv.DictReader(stream)]


def press_ctrl_c(monkeypatch: pytest.MonkeyPatch, at_step: int, times: int = 1, number: int = signal.SIGINT) -> None:
    """Press it once the training has reached a step."""

    class Keyboard:
        pressed = 0

        def update(self, step: int, summary: str = "") -> None:
            while step >= at_step and Keyboard.pressed < times:  # at once: calls come by the clock
                Keyboard.pressed += 1
                signal.raise_signal(number)

        def close(self) -> None:
            pass

    monkeypatch.setattr(training_run, "show_progress", lambda *_: Keyboard())
