import numpy as np

from lidarena.planning.team.pibt import team_step
from lidarena.planning.team.pibt_swap import swap_partner
from tests.planning.team.problems import parse, traffic_of


def partner(drawing: str, robot: int) -> int:
    """With whom a robot has to swap places in a drawing, if it goes on towards its goal."""
    problem = parse(drawing, 4)
    traffic = traffic_of(problem)
    step = team_step(traffic.graph.arrays, traffic.ends[:, 1], 0)
    step.here[:] = traffic.ends[:, 0]
    step.occupant[step.here] = np.arange(len(traffic))
    ways = traffic.graph.neighbours[traffic.ends[robot, 0]]
    best = min((int(place) for place in ways if place >= 0), key=lambda place: int(traffic.ahead[robot, place]))
    return int(swap_partner(np.int64(robot), np.int64(best), traffic.graph.neighbours, traffic.ahead, step))


def test_two_that_meet_in_a_passage_swap_where_it_opens() -> None:
    drawing = """
    @@.@@@@@
    B.ab...A
    @@.@@@@@
    """
    assert partner(drawing, 0) == 1


def test_nobody_swaps_where_there_is_room_to_pass() -> None:
    drawing = """
    ........
    B..ab..A
    ........
    """
    assert partner(drawing, 0) == -1


def test_nobody_swaps_with_one_that_goes_the_same_way() -> None:
    drawing = """
    @@.@@@@@
    ..ab..AB
    @@.@@@@@
    """
    assert partner(drawing, 0) == -1


def test_a_passage_that_ends_on_both_sides_has_no_room_for_a_swap() -> None:
    assert partner("B.ab..A", 0) == -1


def test_a_robot_that_stays_needs_no_swap() -> None:
    problem = parse(
        """
        ab
        AB
        """,
        4,
    )
    traffic = traffic_of(problem)
    step = team_step(traffic.graph.arrays, traffic.ends[:, 1], 0)
    step.here[:] = traffic.ends[:, 0]
    here = np.int64(step.here[0])
    assert swap_partner(np.int64(0), here, traffic.graph.neighbours, traffic.ahead, step) == -1
