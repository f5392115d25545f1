import heapq

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.heap import pop, push


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(st.booleans(), st.integers(0, 19), st.floats(0, 100)), max_size=60))
def test_behaves_as_heapq_with_decreased_keys(operations):
    heap, where, keys = np.empty(20, np.int64), np.full(20, -1, np.int64), np.zeros(20)
    size, model = 0, {}
    for is_pop, item, key in operations:
        if is_pop and model:
            got = pop(heap, where, keys, size)
            size -= 1
            assert model.pop(got) == min([*model.values(), keys[got]])
            assert where[got] == -1
        elif not is_pop:
            keys[item] = model[item] = min(key, model.get(item, np.inf))
            size = push(heap, where, keys, size, item)
        assert size == len(model)
    drained = [float(keys[pop(heap, where, keys, size - i)]) for i in range(size)]
    expected = list(model.values())
    heapq.heapify(expected)
    assert drained == [heapq.heappop(expected) for _ in range(size)]
