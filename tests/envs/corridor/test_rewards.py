"""What the terms of a team's reward are worth."""

from types import SimpleNamespace

import numpy as np
import pytest

from lidarena.envs.corridor.rewards import REWARDS, weigh_terms

ONES = dict.fromkeys(REWARDS.names, 1.0)
MEASURED = SimpleNamespace(
    remaining=np.array([[4.0, 4.0]]), closeness=np.array([[0.5, 0.5]]), velocity=np.array([[[0.3, -2.0], [0.3, -2.0]]])
)
CORE = SimpleNamespace(measurements=MEASURED, options=SimpleNamespace(decision_period=0.2))


def test_a_robot_on_its_way_is_paid_and_a_finished_one_is_not() -> None:
    yes, on_its_way = np.array([[True, True]]), np.array([[True, False]])
    found = weigh_terms(CORE, ONES, np.array([[4.3, 4.3]]), on_its_way, yes, yes)
    assert {name: float(value[0, 0]) for name, value in found.items()} == pytest.approx(
        {"progress": 0.3, "arrival": 1.0, "collision": -1.0, "time": -0.2, "closeness": -0.1, "turning": -0.4}
    )
    assert all(value[0, 1] == 0.0 for value in found.values())


def test_weights_scale_their_terms() -> None:
    no = np.array([[False, False]])
    found = weigh_terms(CORE, {"time": 5.0, "arrival": 0.0}, np.array([[4.0, 4.0]]), ~no, no, ~no)
    assert set(found) == {"time", "arrival"}
    assert found["time"].tolist() == [[-1.0, -1.0]] and not found["arrival"].any()
