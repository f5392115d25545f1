"""Random mazes."""

import numpy as np
import pytest

from lidarena.base.errors import MapError
from lidarena.world.random_plans.mazes import random_maze


def test_what_is_given_is_kept_and_the_rest_is_drawn() -> None:
    plans = [random_maze(np.random.default_rng(k), {"width": 8.0, "height": 6.0, "corridor": 1.5}, "x") for k in (1, 2)]
    assert plans[0].bounds == plans[1].bounds == (0.0, 0.0, 8.0, 6.0)
    assert plans[0].edges.tobytes() != plans[1].edges.tobytes()


def test_corridors_that_do_not_fit_are_refused() -> None:
    with pytest.raises(MapError, match=r"map 'mine' cannot be drawn: .*too small"):
        random_maze(np.random.default_rng(0), {"width": 5.0, "height": 4.0, "corridor": 4.0}, "mine")
