"""The state as records, and as arrays over the same memory."""

import numpy as np

from lidarena.envs.workshop.humans import Traits
from lidarena.envs.workshop.records import make_records, views_of


def test_arrays_are_views_of_the_records() -> None:
    poses = np.zeros((3, 2, 3))
    records = make_records(3, 4, 8, poses)
    workers = views_of(records)
    workers.status[1, 2] = 1
    workers.traits[2] = Traits(pace=1.5)
    records.agents[0, 1]["phase"] = 3
    records.poses[0, 0, 0] = 7.0
    assert records.actions[1, 2]["status"] == 1 and records.human[2]["pace"] == 1.5
    assert workers.phase[0].tolist() == [0, 3] and poses[0, 0, 0] == 7.0


def test_what_has_not_happened_yet_is_told_from_zero() -> None:
    workers = views_of(make_records(2, 3, 5, np.zeros((2, 2, 3))))
    assert np.isnan([workers.begun, workers.placed, workers.ended, workers.worked]).all()
    assert (workers.agent == -1).all() and np.isinf(workers.least_gap).all()
    assert workers.log.shape == (2, 5, 4) and workers.origin.shape == (2, 2)
