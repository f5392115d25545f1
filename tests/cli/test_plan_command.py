"""``lidarena plan``: plans that hold, in metres, for random teams, given places and scenarios; refusals."""

import json
from pathlib import Path

import numpy as np
import pytest

from lidarena.cli import main
from lidarena.evaluation.team_planning.team_experiment import SHIPPED
from lidarena.world.load import load_floorplan
from tests.cli.refusals import assert_refused

WORLD = SHIPPED / "map" / "room-32-32-4.map"
SCENARIO = SHIPPED / "scen-random" / "room-32-32-4-random-1.scen"


def test_a_random_team_keeps_clear_of_walls_and_each_other(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, picture = tmp_path / "paths.json", tmp_path / "paths.png"
    arguments = ["--robots", "4", "--seed", "3", "--radius", "0.15", "--out", str(file), "--picture", str(picture)]
    assert main(["plan", "office", *arguments]) == 0
    assert "cost:" in capsys.readouterr().out and picture.read_bytes().startswith(b"\x89PNG")
    plan = json.loads(file.read_text())
    assert plan["solved"] and plan["cost"] >= plan["lower_bound"] and len(plan["paths"]) == 4
    longest = max(map(len, plan["paths"]))
    places = np.array([path + path[-1:] * (longest - len(path)) for path in plan["paths"]])
    gaps = np.linalg.norm(places[:, None] - places[None], axis=-1) + 1e9 * np.eye(4)[:, :, None]
    assert gaps.min() >= 2 * 0.15
    low_x, low_y, high_x, high_y = load_floorplan("office").bounds
    assert ((places > [low_x, low_y]) & (places < [high_x, high_y])).all()


def test_given_places(tmp_path: Path) -> None:
    file = tmp_path / "paths.json"
    places = ["--from", "2", "2", "--to", "17", "13"]
    assert main(["plan", "office", *places, "--method", "independent_astar", "--out", str(file)]) == 0
    (path,) = json.loads(file.read_text())["paths"]
    assert np.allclose(path[0], [2, 2], atol=0.11) and np.allclose(path[-1], [17, 13], atol=0.11)


def test_a_scenario(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--scen", str(SCENARIO), "--robots", "5", "--radius", "0", "--connectivity", "4"]
    assert main(["plan", str(WORLD), *arguments]) == 0
    assert "grid:     32 x 32 cells of 1 m" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["office", "--robots", "0"], "at least one robot is needed"),
        (["office", "--robots", "100000"], "there is no room for 100000 robots"),
        (["office", "--from", "1", "1"], "1 --from and 0 --to are given"),
        (["office", "--from", "-50", "1", "--to", "2", "2"], "lies outside of the floor plan"),
        (["office", "--cell", "7"], "a resolution of 7.0 m is not possible"),
        (["office", "--radius", "-1"], "--radius is -1 m"),
        ([str(WORLD), "--scen", "nowhere.scen"], "scenario 'nowhere.scen' cannot be read"),
        (["office", "--out", "file.txt/paths.json"], "cannot be written"),
    ],
)
@pytest.mark.usefixtures("folder_with_a_file")
def test_refusals(arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert_refused(["plan", *arguments], sentence, capsys)
