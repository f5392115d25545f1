"""Robots whose map closes the pocket that they have driven into: the compiled one, and the plain one beside it."""

import math
from typing import Any

import numpy as np

from lidarena.planning.driving.explorer import CHOOSES, ENDS, advance, command, set_out
from lidarena.planning.driving.whereabouts import CAUGHT, empty_whereabouts, is_caught, note_whereabouts
from lidarena.world.floorplan import Floorplan
from tests.baselines.exploration.plain_rules import PlainNearestFrontier
from tests.planning.driving.test_explorer import nearest
from tests.planning.driving.worlds import hired, make_world, perceived

MOUTH = 4.0


def hall_with_pocket() -> Floorplan:
    walls = [(0, 0, 4, 0), (0, 2.5, 4, 2.5), (0, 0, 0, 2.5), (4, 0, 4, 1.0), (4, 1.65, 4, 2.5)]
    walls += [(4, 0.2, 5.1, 0.2), (5.1, 0.2, 5.1, 2.3), (4, 2.3, 5.1, 2.3)]
    return Floorplan.from_shapes("pocket", (-0.1, -0.1, 5.2, 2.6), walls, thickness=0.1, start=(0.8, 1.2, 0.3))


def told_wrongly(info: dict[str, Any], closed: bool) -> dict[str, Any]:
    """What is told, but with a mouth that is far too narrow, and a patch in the hall that is never seen."""
    wrong, side = np.array(info["map"]), float(info["resolution"])
    columns, rows = (np.arange(n) * side + at for n, at in zip(wrong.shape[::-1], info["origin"], strict=True))
    wrong[np.ix_((rows > 0.3) & (rows < 0.7), (columns > 0.3) & (columns < 0.7))] = -1
    if closed:
        wrong[np.ix_(np.abs(rows - 1.3) > 0.08, np.abs(columns - MOUTH) < 0.08)] = 100
    return {**info, "map": wrong}


def test_both_drive_out_of_a_pocket_that_the_map_has_closed() -> None:
    env, info = make_world(map=hall_with_pocket(), start=None)
    policy = PlainNearestFrontier(env)
    observation, expected, told, closed, xs = None, [], info, False, [0.0]
    while not policy.finished and len(expected) < 700 and not (closed and xs[-1] < MOUTH - 0.2):
        closed |= xs[-1] > MOUTH + 0.4
        expected.append(int(policy.act(observation, told_wrongly(told, closed))))
        observation, _, _, _, told = env.step(expected[-1])
        xs.append(float(told["pose"][0]))
        assert not told["collision"]
    assert closed and xs[-1] < MOUTH - 0.2
    driver, settings, explorers = hired(env, info)
    info, actions, closed, x = env.reset(seed=1)[1], [], False, 0.0
    for _ in expected:
        closed |= x > MOUTH + 0.4
        senses = perceived(told_wrongly(info, closed))
        status = advance(0, math.log(info["d_optimality"]), senses, driver, settings, explorers)
        assert status != ENDS
        if status == CHOOSES:
            set_out(0, nearest(explorers.candidates), senses, driver, explorers)
        actions.append(command(0, senses, driver, explorers))
        info = env.step(actions[-1])[4]
        x = float(info["pose"][0])
    assert actions == expected


def test_who_stays_near_one_place_for_long_is_caught_until_it_has_gone_back() -> None:
    been, scan, steps = empty_whereabouts(1, 4), np.ones(4, np.float32), round(CAUGHT / 0.2)
    for k in range(steps):
        assert not is_caught(0, 0.2, been)
        note_whereabouts(0, np.array([0.3 * (k % 2), 0.0, 0.0]), scan, True, False, True, been)
    assert is_caught(0, 0.2, been) and been.number[0] == 2
    been.retreats[0] = True
    note_whereabouts(0, np.array([0.7, 0.0, 0.0]), scan, True, True, True, been)
    assert is_caught(0, 0.2, been) and been.retreats[0]
    note_whereabouts(0, np.array([0.8, 0.0, 0.0]), scan, False, False, True, been)
    assert not is_caught(0, 0.2, been) and not been.retreats[0]
    for _ in range(steps):
        note_whereabouts(0, np.array([0.8, 0.0, 0.0]), scan, False, False, True, been)
    note_whereabouts(0, np.array([2.0, 0.0, 0.0]), scan, True, False, True, been)
    assert not is_caught(0, 0.2, been)
