import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.traffic import Traffic
from tests.planning.team.problems import Problem, hall, is_empty, problems, taken_moves, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4)), st.data())
def test_whoever_is_removed_and_placed_again_leaves_the_tables_as_they_were(
    problem: Problem, data: st.DataObject
) -> None:
    traffic = traffic_of(problem)
    placed = traffic.plan(np.arange(len(traffic)))
    everyone = np.flatnonzero(traffic.placed)
    assert len(everyone) == placed
    before = taken_moves(traffic.reserved, traffic.capacity), traffic.reserved.since.copy()
    some = np.array(sorted(data.draw(st.sets(st.sampled_from(everyone.tolist()), min_size=1))))
    traffic.remove(some)
    assert not traffic.placed[some].any() and traffic.placed.sum() == placed - len(some)
    traffic.place(some)
    assert np.array_equal(taken_moves(traffic.reserved, traffic.capacity), before[0])
    assert np.array_equal(traffic.reserved.since, before[1])
    traffic.remove(everyone)
    assert is_empty(traffic.reserved)


def test_a_closed_team_keeps_its_paths_and_leaves_nothing_behind() -> None:
    traffic = hall((0, 44), (8, 36))
    assert traffic.plan(np.array([0, 1])) == 2
    cells, cost = [path.copy() for path in traffic.cells()], traffic.cost()
    traffic.close()
    assert is_empty(traffic.reserved) and traffic.cost() == cost
    for path, old in zip(traffic.cells(), cells, strict=True):
        assert np.array_equal(path, old)
    after = Traffic(traffic.graph, np.array([[0, 44], [8, 36]], np.int64))
    assert after.reserved.rows is traffic.reserved.rows  # the room is lent again


def test_cells_are_the_paths_up_to_the_goal() -> None:
    traffic = hall((0, 8), (9, 9))
    traffic.plan(np.array([0, 1]))
    straight, rest = traffic.cells()
    assert straight.tolist() == [[0, col] for col in range(9)] and rest.tolist() == [[1, 0]]
    assert traffic.lengths.tolist() == traffic.alone.tolist() == [8, 0] and traffic.cost() == 8
