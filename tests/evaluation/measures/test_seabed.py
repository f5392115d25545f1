"""What is measured of a flight over the seabed."""

import math

import numpy as np
import pytest

from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import run_episode
from lidarena.evaluation.measures.seabed import MEASURES
from lidarena.evaluation.participants import make_participants
from lidarena.evaluation.trace import RobotTrace
from tests.envs.seabed.short_flights import SHORT


def test_a_flight_is_measured_drawn_and_described() -> None:
    entry = EnvEntry(id="lidarena/Seabed-v0", keywords=SHORT | {"pick": "random"})
    env, policy = make_participants(entry, PolicyEntry(name="adaptive_step"))
    found = run_episode(env, policy, 0, keep_picture=True)
    values = found.measures
    assert values["success"] == 1.0 and 0.0 < values["error"] < 0.02 and values["collision"] == 0.0
    assert values["drift"] == pytest.approx(values["error"] / values["path"]) and values["compute"] > 0.0
    assert values["positions"] >= 2 and values["refusals"] == 0 and 0.0 < values["nees"] < 300.0
    picture = found.picture
    assert isinstance(picture, RobotTrace) and len(picture.true) == len(picture.estimated) == values["steps"] + 1
    assert np.abs(picture.true - picture.estimated).max() < 0.03


def test_descriptions_tell_the_drift_if_there_is_one() -> None:
    assert MEASURES.describe({"drift": 0.0004}) == "drifted 0.040%"
    assert MEASURES.describe({"drift": math.nan}) == ""
