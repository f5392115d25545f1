import numpy as np

from lidarena.planning.potential_field.regression_search import path_length
from tests.baselines.arena.arena_drives import planner, world


def turns(path: np.ndarray) -> np.ndarray:
    headings = np.arctan2(*np.diff(path, axis=0).T[::-1])
    return np.abs(np.remainder(np.diff(headings) + np.pi, 2.0 * np.pi) - np.pi)


def test_the_path_leads_around_what_is_in_the_way_and_is_smooth() -> None:
    path = planner("apf_global").plan(world([(50.0, 50.0, 6.0)]))
    assert path[0].tolist() == [10.0, 50.0] and path[-1].tolist() == [90.0, 50.0]
    assert (np.hypot(*(path - 50.0).T) > 7.0).all()
    assert path_length(path) < 1.1 * 80.0
    assert np.median(turns(path)) < 0.02
