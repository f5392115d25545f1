import itertools

import numpy as np
import pytest

from lidarena.planning.team.moves import MOVES, conflicting_moves
from tests.planning.team.problems import meet


@pytest.mark.parametrize("apart", [0.0, 0.8, 1.0, 1.5, 2.0, 2.6])
def test_footprints_are_the_conflicts_by_definition(apart):
    table = conflicting_moves(apart, 8)
    for move, other in itertools.product(range(9), repeat=2):
        for cell in itertools.product(range(-5, 6), repeat=2):
            expected = meet((0, 0), cell, tuple(MOVES[move]), tuple(np.add(cell, MOVES[other])), apart)
            assert bool(table[move].get(cell, 0) >> other & 1) == expected, (move, other, cell)
