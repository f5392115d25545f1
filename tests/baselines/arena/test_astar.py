import numpy as np
import pytest

from lidarena.planning.potential_field.regression_search import path_length
from tests.baselines.arena.arena_drives import WALLED_IN, planner, world


def test_the_path_is_the_shortest_on_its_grid() -> None:
    policy = planner("astar")
    assert path_length(policy.plan(world([]))) == pytest.approx(80.0, abs=1.0)
    around = policy.plan(world([(50.0, 50.0, 6.0)]))
    assert 80.0 < path_length(around) < 1.08 * 82.0
    assert (np.hypot(*(around - 50.0).T) > 7.0 - 1e-9).all()


def test_without_a_way_the_path_is_where_the_robot_is() -> None:
    closed = world([tuple(circle) for circle in WALLED_IN])._replace(goal=np.array([70.0, 50.0]))
    assert planner("astar").plan(closed).tolist() == [[10.0, 50.0]]
