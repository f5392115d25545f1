"""A file is read by what it holds, not by its name."""

from pathlib import Path

import numpy as np
import pytest

from lidarena.slam.logs.carmen import save_log
from lidarena.slam.logs.reading import read_recording
from lidarena.slam.logs.recorded_log import LogError
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way
from tests.slam.logs.test_rosbag import bag_of

LOG = record(ring(), way(LAP, stride=0.5))


def test_logs_and_bags_are_told_apart_by_their_first_bytes(tmp_path: Path) -> None:
    text = read_recording(save_log(tmp_path / "a.txt", LOG))
    bag = read_recording(bag_of(tmp_path / "a.bag", "bag").rename(tmp_path / "b.bag"))
    np.testing.assert_allclose(text.ranges, bag.ranges, rtol=1e-5)
    database = next(bag_of(tmp_path / "c", "mcap").glob("*.mcap"))
    np.testing.assert_array_equal(read_recording(database).ranges, bag.ranges)


@pytest.mark.parametrize("name", ["a.bag", "a.db3", "a.mcap"])
def test_text_under_the_name_of_a_bag_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("ODOM 1 2 3")
    with pytest.raises(LogError, match="is damaged, cut off or no rosbag"):
        read_recording(tmp_path / name)
