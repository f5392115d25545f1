"""What is measured of a drive, and that each family is measured by its own."""

import math
from typing import Any

import numpy as np
import pytest

from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import Episode, run_episode
from lidarena.evaluation.measures.arena import MEASURES, barn_score, measure_drive
from lidarena.evaluation.participants import make_participants
from lidarena.evaluation.pictures import Cell, draw_pictures
from lidarena.evaluation.results import contenders, summarise
from lidarena.evaluation.trace import RobotTrace
from tests.evaluation.rows import BY_NAME


def episode(policy: str, seed: int = 0, **keywords: Any) -> Episode:
    entry = EnvEntry(id="lidarena/Arena-v0", keywords={"arena": "yang:u"} | keywords)
    env, driver = make_participants(entry, PolicyEntry(name=policy))
    return run_episode(env, driver, seed, keep_picture=True)


def last_info(success: bool = True, optimal_time: float = math.inf) -> dict[str, Any]:
    truth = {"circles": np.empty((0, 3)), "bounds": np.array([0.0, 0, 100, 100]), "path_length": 40.0}
    return {
        "success": success,
        "time": 40.0,
        "goal": np.array([50.0, 10.5]),
        "distance": 0.5,
        "radius": 1.0,
        "truth": truth | {"optimal_time": optimal_time},
    }


def test_a_drive_is_measured_over_astars_path() -> None:
    places = np.array([[10.0, 10.5], [20, 10.5], [20, 20.5], [30, 20.5], [50, 10.0]])
    values = measure_drive(last_info(), places, [3.0, 2.0, 0.4, 5.0, 1.0], [0.01, 0.03])
    assert values["path_ratio"] == pytest.approx(40.5 / 40.0, rel=0.03)  # A*'s cells lie a little off the line
    assert values["least_clearance"] == 0.4
    turns = math.pi / 2 + math.pi / 2 + math.atan2(10.5, 20)
    assert values["smoothness"] == pytest.approx(turns / 40.0)
    assert values["decision_time"] == pytest.approx(0.02)
    assert math.isnan(values["barn_score"])


def test_without_success_there_is_no_path_to_compare() -> None:
    values = measure_drive(last_info(success=False, optimal_time=5.0), np.zeros((3, 2)), [1.0], [0.1])
    assert all(math.isnan(values[name]) for name in ("path_ratio", "least_clearance", "smoothness"))
    assert values["barn_score"] == 0.0


@pytest.mark.parametrize(
    ("success", "time", "score"),
    [
        (True, 4.0, 0.5),
        (True, 10.0, 0.5),
        (True, 20.0, 0.25),
        (True, 40.0, 0.125),
        (True, 400.0, 0.125),
        (False, 4.0, 0.0),
    ],
)
def test_barns_score_is_capped_at_a_half_and_an_eighth(success: bool, time: float, score: float) -> None:
    assert barn_score(success, time, 5.0) == score
    assert math.isnan(barn_score(success, time, math.inf))


def test_an_arenas_episode_has_the_arenas_measures() -> None:
    found = episode("apf_improved")
    assert list(found.measures) == [column.name for column in MEASURES.table] and found.ending == "success"
    assert 0.9 < found.measures["path_ratio"] < 1.05
    assert 1.0 < found.measures["least_clearance"] < 1.6
    assert math.isnan(found.measures["barn_score"])
    assert isinstance(found.picture, RobotTrace) and found.picture.goal.tolist() == [[70.0, 70.0]]
    assert not len(found.picture.estimated)  # the pose is known
    assert len(found.picture.true) == found.measures["steps"] + 1


def test_what_stops_short_has_failed() -> None:
    found = episode("apf")
    assert found.ending == "policy finished"
    assert found.measures["success"] == 0.0 and math.isnan(found.measures["path_ratio"])


def test_paths_are_compared_among_those_that_arrive() -> None:
    rows = [
        summarise("U", name, [episode(name, seed) for seed in range(6)]) for name in ("apf_improved", "astar", "apf")
    ]
    assert "path_ratio" not in rows[2].metrics
    assert [row.policy for row in contenders(rows, BY_NAME["path_ratio"])] == ["apf_improved", "astar"]
    assert len(contenders(rows, BY_NAME["decision_time"])) == 3


def test_arenas_are_drawn(tmp_path: Any) -> None:
    entry, found = EnvEntry(id="lidarena/Arena-v0", name="U"), episode("apf_improved")
    assert "A*'s path: success" in found.caption
    paths = draw_pictures([[Cell(entry, PolicyEntry(name="apf_improved"), [found])]], tmp_path)
    assert [path.name for path in paths] == ["overview.png", "apf_improved.png"]
