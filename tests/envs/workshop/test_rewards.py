import numpy as np
import pytest

from lidarena.envs.workshop.rewards import REWARDS, weigh_terms


def test_terms_are_what_they_are_called() -> None:
    weights = dict.fromkeys(REWARDS.names, 2.0)
    spent, idle = np.array([0.1, 0.2, 0.3]), np.array([[0.1, 0.0], [0.0, 0.2], [0.0, 0.0]])
    over, undone = np.array([True, True, False]), np.array([0.0, 0.4, 0.5])
    terms = weigh_terms(weights, spent, idle, over, undone, np.array([0.9, 3.0, 0.2]))
    assert terms["time"] == pytest.approx([-0.2, -0.4, -0.6])
    assert terms["completion"].tolist() == terms["deadline"].tolist() == [2.0, 0.0, 0.0]
    assert terms["human_idle"].tolist() == [-0.2, 0.0, 0.0] and terms["robot_idle"].tolist() == [0.0, -0.4, 0.0]
    assert terms["unfinished"].tolist() == [0.0, -0.8, 0.0]
    late = weigh_terms(weights, spent, idle, over, np.zeros(3), np.full(3, 1.01))
    assert late["completion"][0] == 2.0 and late["deadline"][0] == 0.0


def test_presets_name_known_terms() -> None:
    assert all(set(preset) <= set(REWARDS.names) for preset in REWARDS.presets.values())
