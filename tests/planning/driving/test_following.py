import numpy as np

from lidarena.planning.driving.driver import sense
from lidarena.planning.driving.following import can_loiter, clear_queue, has_queue, next_command, plan_commands
from lidarena.planning.driving.survey import survey
from tests.planning.driving.worlds import hired, make_world, perceived


def test_commands_are_planned_along_a_path_and_forgotten() -> None:
    env, info = make_world(map="env1", start=None)
    settings, _, explorers = hired(env, info)
    told, drive = perceived(info), explorers.drive
    sense(0, told, settings, drive)
    assert survey(0, told, settings, drive) and not has_queue(0, drive)
    x, y, heading = info["pose"]
    ahead = np.array([(x + d * np.cos(heading), y + d * np.sin(heading)) for d in np.arange(0.0, 1.0, 0.05)])
    assert plan_commands(0, ahead, told, settings, drive) and has_queue(0, drive)
    assert set(drive.queue[0, : drive.queue_span[0, 1]].tolist()) <= {0, 1, 2}
    clear_queue(0, drive)
    assert not has_queue(0, drive)


def test_a_robot_with_room_around_it_may_loiter_to_the_left() -> None:
    env, info = make_world(map="env1", start=None)
    settings, _, explorers = hired(env, info)
    told, drive = perceived({**info, "map": np.zeros_like(info["map"])}), explorers.drive
    drive.hit_counts[0] = 0
    told.scans[:] = 3.5
    sense(0, told, settings, drive)
    assert can_loiter(0, told.poses[0], drive.near, settings)
    assert next_command(0, told, settings, drive) == 1 == drive.turning[0] == drive.given[0]
