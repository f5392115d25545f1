"""Bags that were cut off: what stands before the cut is kept, to the bit, and it is told."""

from pathlib import Path

import numpy as np
import pytest

from lidarena.slam.logs.cut_bags import read_cut_bag
from lidarena.slam.logs.reading import read_recording
from lidarena.slam.logs.recorded_log import LogError, LogOptions
from lidarena.slam.logs.rosbag import ODOMETRY, SCAN
from tests.slam.logs.test_rosbag import FORMATS, LOG, MOUNT, bag_of, cut

KEEP = LogOptions(keep_cut=True)


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("compressed", [False, True])
def test_what_stands_before_the_cut_is_kept(tmp_path: Path, kind: str, compressed: bool) -> None:
    place = cut(bag_of(tmp_path / f"a.{kind}", kind, compressed=compressed), 0.6)
    log = read_recording(place, KEEP)
    assert 0.3 * len(LOG.ranges) < len(log.ranges) < len(LOG.ranges)
    np.testing.assert_array_equal(log.ranges, LOG.ranges[: len(log.ranges)])
    np.testing.assert_allclose(log.odometry, LOG.odometry[LOG.scan_readings][: len(log.ranges)], atol=1e-6)
    np.testing.assert_allclose(log.mount, MOUNT, atol=1e-9)
    assert any("cut off" in note for note in log.notes)


@pytest.mark.parametrize("kind", ["sqlite3", "mcap"])
def test_a_recorder_that_was_killed_leaves_no_metadata(tmp_path: Path, kind: str) -> None:
    place = bag_of(tmp_path / "a", kind)
    (place / "metadata.yaml").unlink()
    np.testing.assert_array_equal(read_recording(place, KEEP).ranges, LOG.ranges)


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("share", [0.0, 0.001, 0.02])
def test_a_bag_cut_before_its_first_scan_is_refused_in_one_sentence(tmp_path: Path, kind: str, share: float) -> None:
    with pytest.raises(LogError) as refusal:
        read_recording(cut(bag_of(tmp_path / f"a.{kind}", kind), share), KEEP)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("kind", FORMATS)
def test_a_whole_bag_read_from_the_front_has_all_messages(tmp_path: Path, kind: str) -> None:
    bag = read_cut_bag(bag_of(tmp_path / f"a.{kind}", kind), [SCAN, ODOMETRY])
    assert bag is not None
    counts = {each.topic: each.msgcount for each in bag.connections}
    assert counts == {"/scan": len(LOG.ranges), "/odom": len(LOG.times), "/tf_static": 1}
    assert len(bag.messages) == len(LOG.ranges) + len(LOG.times)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", FORMATS)
def test_torn_bytes_end_in_a_sentence_or_in_scans_that_were_there(tmp_path: Path, kind: str, seed: int) -> None:
    place = bag_of(tmp_path / f"a.{kind}", kind)
    file = next(one for one in place.iterdir() if one.suffix != ".yaml") if place.is_dir() else place
    data = bytearray(file.read_bytes())
    rng = np.random.default_rng(seed)
    for at in rng.integers(20, len(data), 30):
        data[at] = rng.integers(256)
    file.write_bytes(data)
    try:
        assert len(read_recording(place, LogOptions(keep_cut=True, skip_torn=True)).ranges)
    except LogError as refusal:
        assert "\n" not in str(refusal)
