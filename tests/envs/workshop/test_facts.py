"""Measures of working together, on hand-made histories."""

import numpy as np
import pytest

from lidarena.envs.workshop.env import WorkshopEnv
from lidarena.envs.workshop.facts import bounds_broken, functional_delay
from lidarena.envs.workshop.task import load_task
from tests.envs.workshop.workshops import chain, play

TASK = load_task(chain(3)).arrays


def test_functional_delay_counts_gaps_between_the_two_and_overlap_against_them() -> None:
    begun, ended = np.array([[0.0, 14.0, 20.0]]), np.array([[10.0, 22.0, 30.0]])
    assert functional_delay(TASK, np.array([[0, 1, 0]]), begun, ended) == pytest.approx([4.0 - 2.0])
    assert functional_delay(TASK, np.array([[0, 0, 0]]), begun, ended) == pytest.approx([0.0])
    assert functional_delay(TASK, np.array([[0, 1, -1]]), begun, ended) == pytest.approx([4.0])


def test_bounds_are_broken_on_both_sides_by_the_human_only() -> None:
    worked = np.array([[3.9, 5.0, 6.1], [4.0, 6.0, 5.0], [1.0, 1.0, 9.0]])
    agent = np.array([[0, 0, 0], [0, 0, 0], [1, 1, 0]])
    share = bounds_broken(TASK, agent, worked, np.ones((3, 3), np.bool_))
    assert share == pytest.approx([2 / 3, 0.0, 1.0])


def test_infos_tell_of_the_past_and_not_of_the_future() -> None:
    for info in play(WorkshopEnv(task="gearbox", human="free"), seed=2):
        done = info["status"] == 2
        assert (info["worked"][done] > 0.0).all() and (info["worked"][~done] == -1.0).all()
        assert (info["begun"] < 0.0).tolist() == (info["status"] == 0).tolist()
        assert (info["ended"][done] <= info["time"] + 1e-9).all() and (info["since"] >= -1e-9).all()
        assert info["completion"] == pytest.approx(done.mean())
    assert info["makespan"] == info["time"] and info["success"]
    assert info["deadline_met"] == (info["time"] <= 200.0)
