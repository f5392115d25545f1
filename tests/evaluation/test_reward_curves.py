"""Reward curves: what the band covers, and what is refused."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from lidarena.agents.learning_curve import LearningCurve
from lidarena.base.errors import ConfigError
from lidarena.evaluation.reward_curves import PANELS, Trainings, band, draw_curves, main, read_curve


def run(folder: Path, slope: float, steps: int = 5) -> Path:
    """A run folder whose return grows by ``slope`` a step; its first row knows of no episode yet."""
    folder.mkdir()
    curve = LearningCurve(folder)
    curve.add(10, 0.1, {})
    for step in range(20, 10 * steps + 20, 10):
        curve.add(step, step / 100, {"rollout/ep_rew_mean": slope * step, "rollout/completeness": 0.5})
    curve.close()
    return folder


def test_a_curve_leaves_out_rows_without_a_value(tmp_path: Path) -> None:
    curve = read_curve(run(tmp_path / "a", 2.0), "episode_return")
    assert curve.tolist() == [[20, 40], [30, 60], [40, 80], [50, 100], [60, 120]]
    assert read_curve(tmp_path / "a", "collision_rate").shape == (0, 2)


def test_the_band_covers_what_all_trainings_have_reached(tmp_path: Path) -> None:
    curves = [read_curve(run(tmp_path / name, k, n), "episode_return") for name, k, n in (("a", 1, 5), ("b", 3, 3))]
    steps, mean, low, high = band(curves)
    assert (steps[0], steps[-1]) == (20, 40)
    assert np.allclose(mean, 2 * steps) and np.allclose(low, steps) and np.allclose(high, 3 * steps)


def test_a_picture_has_a_column_a_kind(tmp_path: Path) -> None:
    folders = [run(tmp_path / name, 1.0) for name in "abc"]
    figure = draw_curves([Trainings("two", folders[:2]), Trainings("one", folders[2:])])
    assert len(figure.axes) == 2 * len(PANELS)
    titles = [axes.get_title() for axes in figure.axes if axes.get_title()]
    assert titles == ["two\n2 seeds: mean and range", "one\n1 seed"]


def test_the_command_writes_the_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, out = run(tmp_path / "a", 1.0), tmp_path / "new" / "curves.png"
    assert main([f"mine={folder}", "--out", str(out)]) == 0
    assert cv2.imread(str(out)) is not None and str(out) in capsys.readouterr().out


@pytest.mark.parametrize("text", ["", "=runs/a", "label=", ","])
def test_a_training_without_a_folder_is_refused(text: str) -> None:
    with pytest.raises(ConfigError, match="names no training"):
        Trainings.parse(text)


def test_a_folder_without_a_curve_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path / "none")]) == 2
    assert "is no run folder" in capsys.readouterr().err
    (tmp_path / "progress.csv").write_text("step,episode_return\n1,x\n")
    with pytest.raises(ConfigError, match="torn"):
        read_curve(tmp_path, "episode_return")
