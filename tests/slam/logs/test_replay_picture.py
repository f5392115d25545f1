import numpy as np

from lidarena.slam.logs.replay import replay
from lidarena.slam.logs.replay_picture import draw_replay
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

LOG = record(ring(), way(LAP)[:80])
RESULT = replay(LOG, 4)


def test_the_map_and_the_wheels_own_map_stand_side_by_side() -> None:
    figure = draw_replay(LOG, RESULT)
    left, right = figure.axes[:2]
    assert left.get_title().startswith("with SLAM") and "wheels alone" in right.get_title()
    assert f"{len(LOG.ranges):,} laser scans" in figure.get_suptitle()
    rows, columns = RESULT.map.occupancy.shape
    assert left.images[0].get_array().shape == (rows, columns, 3)


def test_the_way_begins_and_ends_where_the_robot_did() -> None:
    left = draw_replay(LOG, RESULT).axes[0]
    marks = {line.get_label(): np.ravel(line.get_xydata()) for line in left.lines}
    np.testing.assert_allclose(marks["start"], RESULT.trajectory.poses[0, :2])
    np.testing.assert_allclose(marks["end"], RESULT.trajectory.poses[-1, :2])
    (way_drawn,) = left.collections
    assert len(way_drawn.get_segments()) == len(RESULT.trajectory.poses) - 1
