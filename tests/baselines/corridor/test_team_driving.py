"""Driving by the clock keeps to the plan's times; driving in its order keeps robots apart, however late some are."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.baselines.corridor.team_driving import ClockDriving, OrderedDriving, steer_to
from lidarena.planning.team.precedence import Precedence
from lidarena.planning.team.team_plan import TeamPlan
from tests.baselines.corridor.fleet_cases import busy_plan, drive, points, still
from tests.envs.corridor.corridor_worlds import gaps

RADIUS = 0.15
"""Of robots that were planned for with 0.2 m."""
CURVE = np.array([(0.0, 0.0), (0.2, 0.0), (0.2, 0.0), (0.4, 0.2), (0.4, 0.4)])


def ordered(plan: TeamPlan) -> OrderedDriving:
    return OrderedDriving([points(path) for path in plan.paths], Precedence(plan, 2.0), RADIUS)


@settings(max_examples=40, deadline=None)
@given(st.floats(-math.pi, math.pi), st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
def test_steering_ends_at_the_target_from_wherever_the_robot_looks(heading: float, x: float, y: float) -> None:
    poses, target = np.array([(0.0, 0.0, heading)]), np.array([x, y])
    for _ in range(80):
        speed, rate = steer_to(poses[0], target)
        assert 0.0 <= speed <= 0.5 and abs(rate) <= 2.0
        poses = drive(poses, np.array([(speed, rate)]))[-1]
    assert math.dist(poses[0, :2], target) < 0.05
    assert steer_to(np.array([x, y, heading]), target) == (0.0, 0.0)


@given(st.floats(0.0, 6.0))
def test_by_the_clock_a_robot_is_between_the_points_of_its_path(time: float) -> None:
    at = np.arange(5) * 0.8
    expected = [np.interp(time, at, CURVE[:, k]) for k in range(2)]
    assert ClockDriving([CURVE], 0.8).planned(0, time) == pytest.approx(expected, abs=1e-12)
    assert ClockDriving([CURVE[:1]], 0.8).planned(0, time).tolist() == [0.0, 0.0]


def test_what_remains_begins_with_the_step_that_the_clock_is_in() -> None:
    driving = ClockDriving([CURVE], 0.8)
    for step in range(5):
        state = still(CURVE[:1], 0.8 * step + 0.4)
        assert driving.remaining(0, state).tolist() == CURVE[step:].tolist()
    assert driving.remaining(0, still(CURVE[:1], 99.0)).tolist() == CURVE[4:].tolist()


@pytest.mark.parametrize("seed", range(3))
def test_robots_that_obey_stay_near_where_the_clock_wants_them(seed: int) -> None:
    curves = [points(path) for path in busy_plan(seed).paths]
    driving = ClockDriving(curves, 0.8)
    poses = np.array(
        [(*curve[0], math.atan2(*(curve[1] - curve[0])[::-1]) if len(curve) > 1 else 0) for curve in curves]
    )
    time, strayed = 0.0, []
    while time < 0.8 * max(map(len, curves)) + 2.0:
        poses = drive(poses, driving.commands(still(poses, time)))[-1]
        time += 0.2
        strayed.append([math.dist(pose[:2], driving.planned(robot, time)) for robot, pose in enumerate(poses)])
        assert gaps(poses).min() >= 2 * RADIUS
    assert np.max(strayed) < 0.2 and np.mean(strayed) < 0.05 and np.max(strayed[-1]) < 0.03


@pytest.mark.parametrize("seed", range(4))
def test_in_the_plans_order_nobody_collides_and_all_arrive_however_late_some_are(seed: int) -> None:
    plan, rng = busy_plan(seed), np.random.default_rng(seed)
    driving = ordered(plan)
    poses = np.array([(*curve[0], rng.uniform(-3, 3)) for curve in driving.curves])
    slowness = np.ones((5, 1))
    for period in range(900):
        if period % 15 == 0:  # somebody stands for 3 s, somebody is slow
            slowness = rng.choice([0.0, 0.4, 1.0], (5, 1))
        state = still(poses, 0.2 * period)
        driving.note(state)
        before = driving.completed.copy()
        seen = drive(poses, driving.commands(state) * slowness)
        assert gaps(np.stack(seen)).min() >= 2 * RADIUS
        assert (driving.completed == before).all()  # commands notes nothing
        poses = seen[-1]
        if all(math.dist(pose[:2], curve[-1]) < 0.05 for pose, curve in zip(poses, driving.curves, strict=True)):
            return
    raise AssertionError(f"still on the way: {driving.completed} of {driving.curves}")


def crossing() -> TeamPlan:
    """Robot 0 goes up through the middle at once, robot 1 waits and goes through it from left to right."""
    up = np.array([(row, 5) for row in range(1, 10)])
    right = np.array([(5, 0)] * 6 + [(5, col) for col in range(1, 11)])
    return TeamPlan(True, [up, right], 22.0, 18.0, False, "", (0, 1))


def test_who_is_to_pass_later_stops_before_the_crossing_and_says_for_whom_it_waits() -> None:
    driving = ordered(crossing())
    poses = np.array([(*driving.curves[0][0], math.pi / 2), (*driving.curves[1][0], 0.0)])
    for period in range(60):  # robot 0 does not move
        state = still(poses, 0.2 * period)
        driving.note(state)
        commands = driving.commands(state)
        commands[0] = 0.0
        poses = drive(poses, commands)[-1]
    assert driving.waits == ((1, 0),) and driving.completed[0] == 0
    stops_at = poses[1, 0]
    assert 0.3 < stops_at < 1.1 - 2 * 0.2 + 0.01  # in front of the column in which robot 0 will pass
    for period in range(60, 200):
        state = still(poses, 0.2 * period)
        driving.note(state)
        poses = drive(poses, driving.commands(state))[-1]
    assert driving.completed.tolist() == [8, 15] and driving.waits == ()


def test_no_step_is_completed_before_it_may_be_begun() -> None:
    driving, order, nobody = ordered(crossing()), Precedence(crossing(), 2.0), np.zeros(2, np.int64)
    first = next(step for step in range(15) if len(order.blocking_agents(1, step, nobody)))
    driving.completed[1] = first
    driving.note(still(np.stack([driving.curves[0][0], driving.curves[1][first + 1]])))  # pushed there, perhaps
    assert driving.completed.tolist() == [0, first]


def test_a_robot_that_cut_a_corner_or_need_not_step_aside_any_more_goes_on() -> None:
    corner = np.array([(5, 0), (5, 1), (4, 2), (3, 3), (2, 4), (2, 5), (2, 6)])
    aside = np.array([(15, 3), (14, 3), (14, 3), (15, 3), (15, 4), (15, 5), (15, 6)])
    driving = ordered(TeamPlan(True, [corner, aside], 12.0, 9.0, False, ""))
    poses = np.array([(*driving.curves[0][0], -1.3), (*driving.curves[1][0], 0.0)])
    for period in range(40):
        state = still(poses, 0.2 * period)
        driving.note(state)
        poses = drive(poses, driving.commands(state))[-1]
    assert driving.completed.tolist() == [6, 6]


def test_a_robot_that_has_arrived_blocks_nobody_and_is_told_nothing() -> None:
    driving = ordered(crossing())
    poses = np.stack([driving.curves[0][-1], driving.curves[1][0]])
    state = still(poses, arrived=(0,))
    driving.note(state)
    assert driving.completed[0] == 8 and driving.remaining(0).tolist() == driving.curves[0][8:].tolist()
    commands = driving.commands(state)
    assert not commands[0].any() and commands[1, 0] == 0.5 and driving.waits == ()


@pytest.mark.parametrize(("away", "stops"), [((0.33, 0.0), True), ((0.55, 0.0), False), ((-0.33, 0.0), False)])
def test_a_robot_stops_before_it_touches_one_that_no_plan_foresaw(away: tuple[float, float], stops: bool) -> None:
    paths = [np.array([(5, col) for col in range(10)]), np.array([(15, 15)])]
    driving = ordered(TeamPlan(True, paths, 9.0, 9.0, True, ""))
    here = driving.curves[0][0]
    state = still(np.stack([here, here + away]), arrived=(1,))
    driving.note(state)
    commands = driving.commands(state)
    assert (commands[0, 0] == 0.0) == stops
    assert driving.waits == (((0, 1),) if stops else ())


def test_a_robot_that_drives_away_from_one_too_near_does_not_stop() -> None:
    driving = ordered(TeamPlan(True, [np.array([(5, 4), (5, 5)]), np.array([(15, 15)])], 1.0, 1.0, True, ""))
    here = driving.curves[0][1] - (0.1, 0.0)
    commands = driving.commands(still(np.array([here, (here[0] - 0.1, here[1] + 0.3)]), arrived=(1,)))
    assert commands[0, 0] == pytest.approx(0.1 / 0.6) and driving.waits == ()


def test_everybody_begins_at_once_where_nobody_is_in_the_way() -> None:
    paths = [np.array([(row, col) for col in range(8)]) for row in (2, 8, 14)]
    driving = ordered(TeamPlan(True, paths, 21.0, 21.0, True, ""))
    commands = driving.commands(still(np.stack([curve[0] for curve in driving.curves])))
    assert commands.tolist() == [[0.5, 0.0]] * 3
    for a, b in itertools.pairwise(driving.remaining(1)):
        assert b[0] - a[0] == pytest.approx(0.2)
