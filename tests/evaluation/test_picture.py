import numpy as np

from lidarena.evaluation.picture import bounds_around


def test_bounds_hold_every_point_of_every_group() -> None:
    groups = [np.array([[0.0, 1.0], [2.0, -3.0]]), np.array([[-1.0, 0.5]]), np.empty((0, 2))]
    assert bounds_around(groups) == (-1.0, 2.0, -3.0, 1.0)


def test_a_team_s_paths_count_with_all_robots() -> None:
    paths = np.stack([np.zeros((4, 2)), np.full((4, 2), 7.0)], axis=1)
    assert bounds_around([paths]) == (0.0, 7.0, 0.0, 7.0)
