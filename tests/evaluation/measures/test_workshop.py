import math
from typing import Any

import pytest

from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import Episode, run_episode
from lidarena.evaluation.measures.workshop import MEASURES
from lidarena.evaluation.participants import make_participants


def episode(policy: str, seed: int = 0, **keywords: Any) -> Episode:
    entry = EnvEntry(id="lidarena/Workshop-v0", keywords={"task": "pile"} | keywords)
    env, driver = make_participants(entry, PolicyEntry(name=policy))
    return run_episode(env, driver, seed)


def test_every_column_is_measured() -> None:
    found = episode("greedy")
    values = found.measures
    assert {column.name for column in found.columns} == {column.name for column in MEASURES.table}
    assert values["completion"] == 1.0 and values["deadline_met"] in (0.0, 1.0) and 40 < values["makespan"] < 120
    assert all(0.0 <= values[name] <= 1.0 for name in ("human_idle", "robot_idle", "concurrent", "bounds_broken"))
    assert math.isnan(values["stranded"]) and values["separation"] >= 0.38
    assert found.ending == "success" and found.caption.startswith("done in")
    assert found.progress is not None and found.progress.points[-1, 1] == 1.0


def test_what_is_cut_off_is_told_as_a_share() -> None:
    found = episode("turn_taking", time_limit=30.0)
    assert found.measures["success"] == 0.0 and 0.0 <= found.measures["completion"] < 1.0
    assert "% done" in found.caption and found.ending == "out of time"


@pytest.mark.parametrize("policy", ["random", "stnu"])
def test_policies_of_all_kinds_run(policy: str) -> None:
    assert episode(policy).measures["completion"] == 1.0
