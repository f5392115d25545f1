"""The page of random floor plans."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from lidarena.world.random_plans.__main__ import draw_page, main


def test_a_page_has_a_row_for_every_spec_and_a_column_for_every_plan() -> None:
    one, more = draw_page(["random:rooms"], 1, 4), draw_page(["random:rooms", "random:cave?area=40"], 3, 4)
    assert one.shape[0] == one.shape[1] and more.shape == (2 * one.shape[0], 3 * one.shape[1], 3)
    assert np.array_equal(more[: len(one), : len(one)], one)
    assert not np.array_equal(more[: len(one), len(one) : 2 * len(one)], one)


def test_the_page_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "new" / "worlds.png"
    assert main(["random:warehouse", "--each", "2", "--seed", "3", "--out", str(path)]) == 0
    assert cv2.imread(str(path))[..., ::-1].tobytes() == draw_page(["random:warehouse"], 2, 3).tobytes()
    assert capsys.readouterr().out.strip() == str(path)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["random:cabe"], "no kind of random plans 'cabe'; did you mean 'cave'"),
        (["random:rooms?dor=1"], "no option 'dor'; did you mean 'door'"),
    ],
)
def test_what_there_is_not_is_refused(
    arguments: list[str], sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "worlds.png"
    assert main([*arguments, "--out", str(path)]) == 2
    assert sentence in capsys.readouterr().err and not path.exists()


@pytest.mark.parametrize("arguments", [["--each", "0"], ["--seed", "-1"]])
def test_no_plans_and_no_seeds_are_refused(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(arguments)
    assert "at least one plan and a seed from 0 are needed" in capsys.readouterr().err
