import math

import numpy as np

from lidarena.planning.driving.driver import sense
from lidarena.planning.driving.survey import survey
from tests.planning.driving.worlds import hired, make_world, perceived


def test_nothing_can_be_surveyed_of_an_unknown_map() -> None:
    env, info = make_world()
    settings, _, explorers = hired(env, info)
    told = perceived({**info, "map": np.full_like(info["map"], -1)})
    sense(0, told, settings, explorers.drive)
    assert not survey(0, told, settings, explorers.drive)


def test_what_the_beams_hit_nearby_is_occupied_for_two_seconds() -> None:
    env, info = make_world()
    settings, _, explorers = hired(env, info)
    near = explorers.drive.near
    blank = {**info, "map": np.zeros_like(info["map"])}
    leg = {**blank, "scan": np.full(len(info["scan"]), 3.5, np.float32)}
    leg["scan"][0] = 0.4

    def occupied(told: dict[str, np.ndarray]) -> int:
        sense(0, perceived(told), settings, explorers.drive)
        rows, columns = near.extent[0, 2:].tolist()
        cells = near.occupancy[0, : rows * columns].reshape(rows, columns)
        x, y, heading = info["pose"]
        column = math.floor((x + 0.4 * math.cos(heading) - near.frame[0, 0]) / 0.05)
        row = math.floor((y + 0.4 * math.sin(heading) - near.frame[0, 1]) / 0.05)
        return int(cells[row, column])

    nothing = {**leg, "scan": np.full(len(info["scan"]), 3.5, np.float32)}
    assert occupied(leg) == 100
    assert [occupied(nothing) for _ in range(10)] == [100] * 9 + [0]
