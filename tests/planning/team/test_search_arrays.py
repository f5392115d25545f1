import numpy as np

from lidarena.planning.team.search_arrays import NEVER, empty_tables
from tests.planning.team.problems import is_empty


def test_fresh_tables_reserve_nothing_and_bound_nothing() -> None:
    tables = empty_tables(12, 30)
    assert is_empty(tables.reserved) and tables.times == 30
    assert tables.reserved.table.shape == (12, 30) and tables.reserved.since.shape == (12, 9)
    assert (tables.memory.limits[:2] == 2**31 - 1).all()


def test_there_is_room_for_every_state_on_the_open_list() -> None:
    memory = empty_tables(12, 30).memory
    assert memory.nodes.shape == (12 * 30, 3) and len(memory.keys) == len(memory.items) >= 4 * 12 * 30


def test_never_is_later_than_any_table_and_fits_its_type() -> None:
    assert np.iinfo(np.int32).max > NEVER > 10**8
