import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.search_arrays import NEVER, NO_ROWS, NO_STATES, empty_tables, entry_of, with_more_room
from tests.planning.team.problems import is_empty


def test_fresh_tables_reserve_nothing_and_bound_nothing() -> None:
    tables = empty_tables(12, 30)
    assert is_empty(tables.reserved) and tables.times == 32  # whole spans
    assert tables.reserved.rows.shape == (12, 2) and tables.reserved.since.shape == (12, 9)
    assert (tables.memory.limits[:2] == 2**31 - 1).all()


def test_every_state_of_a_small_graph_has_room() -> None:
    memory = empty_tables(12, 30).memory
    assert 3 * len(memory.nodes) >= 4 * 12 * 30 and len(memory.keys) == len(memory.items) >= len(memory.nodes)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(0, 2**40), min_size=1, max_size=90, unique=True))
def test_states_have_entries_of_their_own_until_the_next_search(states: list[int]) -> None:
    nodes = np.zeros((128, 4), np.int64)
    for stamp in (1, 2):
        for state in states:
            entry = entry_of(nodes, state, stamp)
            assert nodes[entry, 1] < stamp  # it is free for this search
            nodes[entry, :2] = state, stamp
        entries = [entry_of(nodes, state, stamp) for state in states]
        assert len(set(entries)) == len(states) and nodes[entries, 0].tolist() == states


@pytest.mark.parametrize("lacking", [NO_ROWS, NO_STATES])
def test_tables_grow_by_what_was_lacking_and_keep_what_is_reserved(lacking: int) -> None:
    tables = empty_tables(12, 30)
    tables.reserved.counts[3, 5] = 7
    assert with_more_room(tables) is None
    tables.memory.limits[5], tables.memory.limits[1] = lacking, 99
    larger = with_more_room(tables)
    assert larger is not None and larger.memory.limits[5] == 0 and larger.memory.limits[1] == 99
    assert larger.reserved.counts[3, 5] == 7
    assert (len(larger.reserved.counts) > len(tables.reserved.counts)) == (lacking == NO_ROWS)
    assert (len(larger.memory.nodes) > len(tables.memory.nodes)) == (lacking == NO_STATES)


def test_never_is_later_than_any_table_and_fits_its_type() -> None:
    assert np.iinfo(np.int32).max > NEVER > 10**8
