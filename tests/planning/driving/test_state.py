import numpy as np

from lidarena.planning.driving.state import forget
from tests.planning.driving.worlds import hired, make_world


def test_what_is_forgotten_in_one_world_leaves_nothing_behind() -> None:
    env, info = make_world()
    _, _, explorers = hired(env, info)
    drive = explorers.drive
    drive.has_goal[0], drive.path_points[0], drive.queue_span[0] = True, 7, (2, 9)
    drive.hit_counts[0], drive.turning[0], drive.kept[0] = 3, 1, 0.2
    forget(drive, 0)
    fresh = hired(env, info)[2].drive
    assert not drive.has_goal[0] and drive.turning[0] == -1 and np.isinf(drive.kept[0])
    for name in ("path_points", "queue_span", "hit_counts", "newest"):
        assert np.array_equal(getattr(drive, name), getattr(fresh, name))
