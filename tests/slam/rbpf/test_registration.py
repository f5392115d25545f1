"""Points of a scan are stamped where a particle knows no wall yet."""

import numpy as np
import pytest

from lidarena.slam.rbpf.likelihood_field import (
    empty_fields,
)
from tests.slam.rbpf.dense_field import dense
from tests.slam.rbpf.test_likelihood_field import register, seen_at


def test_a_wall_is_invisible_from_behind() -> None:
    fields = empty_fields(1, 1, 32, 32)
    register(fields, 0, 0.775, 0.775, 4)
    assert seen_at(fields, 0.775, 0.775, 4) == pytest.approx(1.0, abs=5e-3)
    assert seen_at(fields, 0.775, 0.775, 6) > 0.9
    assert seen_at(fields, 0.775, 0.775, 12) == 0.0
    assert seen_at(fields, -0.1, 0.775, 4) == seen_at(fields, 20.0, 0.775, 4) == 0.0


def test_a_wall_that_is_known_is_not_stamped_again() -> None:
    fields = empty_fields(1, 1, 32, 32)
    register(fields, 0, 0.775, 0.775, 4)
    before = dense(fields, 0).copy()
    register(fields, 0, 0.785, 0.775, 4)  # a centimetre beside it
    assert np.array_equal(dense(fields, 0), before)
    register(fields, 0, 0.975, 0.775, 4)
    assert not np.array_equal(dense(fields, 0), before)


def test_what_lies_beyond_the_grid_is_left_out() -> None:
    fields = empty_fields(1, 1, 32, 32)
    for x, y in ((-0.3, 0.5), (0.5, -0.3), (9.0, 0.5), (0.5, 9.0)):
        register(fields, 0, x, y, 0)
    assert not dense(fields, 0).any()
