import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.open_list import pop, push


@settings(deadline=None)  # the first example compiles
@given(st.lists(st.integers(0, 50), max_size=60))
def test_the_open_list_sorts(numbers):
    keys, items = np.empty(64, np.int64), np.empty(64, np.int32)
    size = 0
    for item, key in enumerate(numbers):
        size = push(keys, items, np.int64(size), np.int64(key), np.int64(item))
    taken = []
    while size > 0:
        taken.append((int(keys[0]), int(items[0])))
        size = pop(keys, items, np.int64(size))
    assert [key for key, _ in taken] == sorted(numbers)
    assert all(numbers[item] == key for key, item in taken)
