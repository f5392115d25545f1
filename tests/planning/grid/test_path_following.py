import itertools
import math

import numpy as np
import pytest

from lidarena.planning.grid.grid_search import find_path
from lidarena.planning.grid.inflation import Inflation, clearance, inflate
from lidarena.planning.grid.path_following import PathFollower, blocked_ahead, lookahead_point, predict
from lidarena.planning.grid.steering import Commands
from lidarena.planning.grid.surroundings import Surroundings, gap_at

RES = 0.05
DISCRETE = Commands.of([(0.5, 0.0), (0.05, 0.3), (0.05, -0.3)], 0.2)
CONTINUOUS = Commands.of([(0.5, 0.0), (0.0, 1.0), (0.0, -1.0), (0.5, 0.5), (0.5, -0.5)], 0.2)


def world(*rows, side=10):
    """From a drawing, '#' solid, top row first; a character is ``side`` cells wide."""
    flat = np.array([[100 * (char == "#") for char in row] for row in rows], np.int8)[::-1]
    occupancy = np.kron(flat, np.ones((side, side), np.int8))
    return occupancy, Surroundings(clearance(occupancy, RES), occupancy > 0, RES, (0.0, 0.0))


def line(x0, y0, x1, y1, n=30):
    return np.stack([np.linspace(x0, x1, n), np.linspace(y0, y1, n)], axis=1)


def lookahead_of(around, path, pose, lookahead=1.5, margin=0.18):
    return lookahead_point(path, np.array(pose, float), around.gap, around.closed, around.frame, lookahead, margin)


def drive(commands, occupancy, around, pose, goal, noise=0.0, steps=2000, replan=5):
    """Follow the planned path to the goal, planning every few commands; returns the poses and commands."""
    rng = np.random.default_rng(5)
    path = around.points(
        find_path(inflate(occupancy, RES, Inflation(0.2, 0.6)), around.cell(*pose[:2]), around.cell(*goal))
    )
    assert len(path)
    follower, here, trace, done = PathFollower(commands), np.array(pose, float), [], []
    for step in range(steps):
        if math.dist(here[:2], goal) < 0.3:
            break
        if step % replan == 0 or not len(follower.planned) or not follower.is_clear(here, around):
            assert follower.plan(path, here, around) or follower.is_clear(here, around)
        command = follower.next()
        assert command is not None
        here = predict(here, commands, np.array([command]))[0] + rng.normal(0.0, noise, 3)
        trace.append(here)
        done.append(command)
    return np.array(trace), done


MAZE = ("#########", "#   #   #", "# # # # #", "# #   # #", "#########")


@pytest.mark.parametrize("commands", [DISCRETE, CONTINUOUS], ids=["discrete", "continuous"])
@pytest.mark.parametrize("noise", [0.0, 0.004])
def test_follows_a_path_through_corridors_without_touching(commands, noise):
    occupancy, around = world(*MAZE, side=16)
    trace, _ = drive(commands, occupancy, around, (1.2, 1.2, math.pi / 2), (6.0, 1.2), noise)
    assert math.dist(trace[-1, :2], (6.0, 1.2)) < 0.3
    gaps = [gap_at(around.gap, around.closed, around.frame, x, y) for x, y, _ in trace]
    assert min(gaps) > 0.14


def test_does_not_swing_to_and_fro():
    occupancy, around = world(*MAZE, side=16)
    for noise in (0.0, 0.002):
        _, done = drive(DISCRETE, occupancy, around, (1.2, 1.2, math.pi / 2), (6.0, 1.2), noise)
        turns = [command for command in done if command != 0]
        flips = sum(a != b for a, b in itertools.pairwise(turns))
        assert flips <= 16  # the way has eight corners


def test_is_deterministic():
    occupancy, around = world(*MAZE, side=16)
    runs = [drive(DISCRETE, occupancy, around, (1.2, 1.2, math.pi / 2), (6.0, 1.2))[1] for _ in range(2)]
    assert runs[0] == runs[1]


def test_turns_round_at_the_end_of_a_dead_end():
    occupancy, around = world("############", "#          #", "############", side=16)
    trace, _ = drive(DISCRETE, occupancy, around, (1.5, 1.2, 0.0), (8.4, 1.2))
    back, _ = drive(DISCRETE, occupancy, around, trace[-1], (1.5, 1.2))
    assert math.dist(back[-1, :2], (1.5, 1.2)) < 0.3


def test_the_lookahead_point_is_the_farthest_point_in_sight():
    _, around = world("######", "#    #", "#    #", "######", side=20)
    path = np.vstack([line(1.5, 1.5, 3.5, 1.5, 21), line(3.6, 1.5, 4.4, 1.5, 9)])
    assert path[lookahead_of(around, path, (1.5, 1.5, 0.0))] == pytest.approx((3.0, 1.5))
    assert lookahead_of(around, path, (1.5, 1.5, 0.0), lookahead=100.0) == len(path) - 1
    assert path[lookahead_of(around, path, (2.0, 1.7, 0.0))] == pytest.approx((3.5, 1.5))


def test_the_lookahead_point_stays_near_where_the_path_bends_behind_a_wall():
    _, around = world("######", "#    #", "## ###", "## ###", "######", side=16)
    path = np.vstack([line(2.0, 1.2, 2.0, 2.8, 33), line(2.05, 2.8, 3.9, 2.8, 38)])
    chosen = path[lookahead_of(around, path, (2.0, 1.6, math.pi / 2), lookahead=3.0)]
    assert chosen[0] < 2.6 and chosen[1] > 2.5


def test_the_lookahead_point_goes_on_even_if_nothing_is_in_sight():
    _, around = world("#####", "# # #", "#####", side=16)
    path = line(1.2, 1.2, 2.8, 1.2, 17)
    assert path[lookahead_of(around, path, (1.2, 1.2, 0.0))] == pytest.approx((1.6, 1.2))


def test_path_is_found_blocked_only_where_it_still_leads():
    occupancy, _ = world("######", "#    #", "######", side=20)
    path = line(1.2, 1.5, 4.8, 1.5, 60)
    occupancy[25:35, 60] = 100
    around = Surroundings(clearance(occupancy, RES), occupancy > 0, RES, (0.0, 0.0))
    assert blocked_ahead(path, np.array([1.5, 1.5, 0.0]), around, 0.14)
    assert not blocked_ahead(path, np.array([3.4, 1.5, 0.0]), around, 0.14)
    window = Surroundings(around.gap[:, :50], around.closed[:, :50], RES, (0.0, 0.0))
    assert not blocked_ahead(path, np.array([1.5, 1.5, 0.0]), window, 0.14)  # beyond what is looked at


def test_commands_run_out_and_are_forgotten():
    _, around = world("######", "#    #", "######", side=20)
    follower = PathFollower(DISCRETE)
    assert follower.next() is None
    assert follower.plan(line(1.5, 1.5, 4.0, 1.5), np.array([1.5, 1.5, 0.0]), around)
    n = len(follower.planned)
    assert n and follower.next() == 0 and len(follower.planned) == n - 1
    follower.clear()
    assert follower.next() is None and not len(follower.planned)


def test_a_new_obstacle_is_noticed_before_the_next_command():
    occupancy, around = world("######", "#    #", "######", side=20)
    pose = np.array([1.5, 1.5, 0.0])
    follower = PathFollower(DISCRETE)
    follower.plan(line(1.5, 1.5, 4.0, 1.5), pose, around)
    assert follower.is_clear(pose, around)
    occupancy[28:32, 38:42] = 100
    changed = Surroundings(clearance(occupancy, RES), occupancy > 0, RES, (0.0, 0.0))
    assert not follower.is_clear(pose, changed)


def test_keeps_the_old_plan_where_it_finds_no_new_one():
    _, around = world("######", "#    #", "######", side=20)
    pose = np.array([1.5, 1.5, 0.0])
    follower = PathFollower(DISCRETE)
    follower.plan(line(1.5, 1.5, 4.0, 1.5), pose, around)
    before = follower.planned.copy()
    assert not follower.plan(np.array([[1.5, 0.5]]), pose, around)
    np.testing.assert_array_equal(follower.planned, before)


def test_a_plan_that_beams_contradict_is_not_taken():
    _, around = world("######", "#    #", "######", side=20)
    pose = np.array([1.5, 1.5, 0.0])
    follower = PathFollower(DISCRETE, keep=0.135)
    follower.points = np.array([[0.5, y] for y in np.arange(-1.0, 1.0, 0.02)])  # a wall across the way
    assert not follower.plan(line(1.5, 1.5, 4.0, 1.5), pose, around) and not len(follower.planned)
    follower.points = np.array([[-0.5, 0.0]])
    assert follower.plan(line(1.5, 1.5, 4.0, 1.5), pose, around) and len(follower.planned)
