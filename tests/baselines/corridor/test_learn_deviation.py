from pathlib import Path

import pytest

from lidarena.baselines.corridor.deviation_model import DeviationModel
from lidarena.baselines.corridor.learn_deviation import main, record_runs


def test_it_is_learned_from_executions_by_a_command(tmp_path, capsys):
    main(["--runs", "1", "--out", str(tmp_path / "model.json"), "--picture", str(tmp_path / "picture.png")])
    assert "1 runs" in capsys.readouterr().out
    assert DeviationModel.load(tmp_path / "model.json").counts.sum() > 100
    assert (tmp_path / "picture.png").stat().st_size > 5_000


def test_without_noise_robots_hardly_deviate():
    quiet = record_runs(1, motion_noise=0.0, localization_noise=0.0)
    assert quiet.mean() < record_runs(1, motion_noise=3.0).mean()


@pytest.mark.parametrize("option", ["--out", "--picture"])
def test_a_place_that_cannot_be_written_is_told_before_the_work(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    places = {"--out": str(tmp_path / "model.json"), "--picture": str(tmp_path / "picture.png")}
    places[option] = str(tmp_path / "file" / "new")
    assert main([word for pair in places.items() for word in pair]) == 2
    assert f"'{tmp_path / 'file' / 'new'}' cannot be written: " in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
