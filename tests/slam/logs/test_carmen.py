import gzip
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.logs.carmen import LogError, RecordedLog, read_log, save_log
from lidarena.slam.logs.recorded_log import LogOptions

ODOM = "ODOM 1 2 0.5 0 0 0 100.0 host 0.0"
FLASER = "FLASER 4 1.5 2.5 3.5 81.83 0 0 0 1 2 0.5 100.5 host 0.5"
ROBOT = "ROBOTLASER1 0 -1.0 2.0 0.5 80.0 0.01 0 5 1 2 3 4 80 2 7 8 1.2 2.0 0.1 1.0 2.0 0.0 0 0 0 0 0 101.0 host 1.0"


def write(tmp_path: Path, *lines: str) -> Path:
    file = tmp_path / "a.log"
    file.write_text("\n".join(lines) + "\n")
    return file


def simple(scans: int, beams: int, seed: int, longest: float = 50.0) -> RecordedLog:
    rng = np.random.default_rng(seed)
    readings = np.sort(rng.choice(2 * scans, scans, replace=False))
    step = math.pi / (beams - 1 if beams % 2 else beams)
    return RecordedLog(
        name="a.log.gz",
        times=1e9 + np.cumsum(rng.integers(0, 1000, 2 * scans)) / 1000,
        odometry=np.cumsum(rng.uniform(-0.1, 0.1, (2 * scans, 3)), axis=0).round(6),
        scan_readings=readings,
        ranges=rng.uniform(0.01, 0.99 * longest, (scans, beams)).round(2).astype(np.float32),
        angles=-math.pi / 2 + step * np.arange(beams),
        max_range=longest,
        mount=np.zeros(3),
    )


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 6), st.integers(2, 12), st.integers(0, 2**32 - 1))
def test_a_log_that_was_saved_reads_back_the_same(scans: int, beams: int, seed: int) -> None:
    import tempfile

    log = simple(scans, beams, seed)
    with tempfile.TemporaryDirectory() as folder:
        for name in ("a.log.gz", "a.log"):
            again = read_log(save_log(Path(folder) / name, log))
            assert again.name == name
            assert np.array_equal(again.scan_readings, log.scan_readings)
            assert np.array_equal(again.ranges, log.ranges)
            np.testing.assert_allclose(again.times, log.times, atol=1e-6)
            np.testing.assert_allclose(again.odometry, log.odometry, atol=1e-6)
            np.testing.assert_allclose(again.angles, log.angles, atol=1e-12)
            assert again.max_range == log.max_range


def test_both_messages_and_the_longest_range_are_read(tmp_path: Path) -> None:
    old = read_log(write(tmp_path, "# comment", "PARAM robot_front_laser_max 81.83", ODOM, "", FLASER))
    assert old.scan_readings.tolist() == [1]
    assert old.times.tolist() == [100.0, 100.5]
    assert old.odometry[1].tolist() == [1.0, 2.0, 0.5]
    np.testing.assert_allclose(np.degrees(old.angles), [-90, -45, 0, 45])
    assert old.max_range == 81.83
    new = read_log(write(tmp_path, ROBOT))
    np.testing.assert_allclose(new.angles, [-1.0, -0.5, 0.0, 0.5, 1.0])
    np.testing.assert_allclose(new.mount, [0.2, 0.0, 0.1])
    assert new.max_range == 80.0
    assert new.ranges.tolist() == [[1, 2, 3, 4, 80]]


def test_messages_of_other_devices_are_passed_over(tmp_path: Path) -> None:
    log = read_log(write(tmp_path, "SONAR 3 1 2 3", "TRUEPOS what ever", FLASER))
    assert len(log.times) == 1


def test_a_clock_that_stutters_is_believed(tmp_path: Path) -> None:
    log = read_log(write(tmp_path, FLASER, ODOM))
    assert log.times.tolist() == [100.5, 100.0]


def test_torn_lines_can_be_skipped(tmp_path: Path) -> None:
    log = read_log(write(tmp_path, FLASER, FLASER[:30], "1.2 3.4", ODOM), skip_torn=True)
    assert (len(log.times), log.skipped) == (2, 2)


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        ([FLASER, FLASER[:30]], "line 2 of log .* is torn: FLASER has 8 words where 15 are needed for 4 beams"),
        ([FLASER, "FLASER"], "line 2 .* torn"),
        ([FLASER, "FLASER many 1 2"], "line 2 .* torn: it has 'many' where a number is needed"),
        ([FLASER.replace("2.5", "2,5")], "line 1 .* torn: it has '2,5'"),
        ([FLASER, "ODOM 1 2 3"], "line 2 .* torn: ODOM has 4 words where 10 are needed"),
        ([FLASER, "3.5 81.83 0 0 0 1 2"], "line 2 .* begins with '3.5', which is no message"),
        ([ROBOT[:60]], "line 1 .* torn"),
        ([ODOM, ODOM], "has no scans"),
        ([], "has no scans"),
        ([FLASER.replace("1 2 0.5 100.5", "1e100 2 0.5 100.5")], r"line 1 .* torn: it has 1e\+100 where"),
        ([ODOM.replace("ODOM 1", "ODOM -1e9"), FLASER], r"line 1 .* torn: it has -1e\+09 where"),
        (
            [FLASER, *(ODOM.replace("100.0", str(90.4 - 4 * k)) for k in range(4))],
            "has 4 of 5 time stamps that do not run forwards, the first of them .* .--ignore-times",
        ),
        ([FLASER.replace(part, "nan") for part in ("1.5 2.5 3.5 81.83",)], "no scan with a single return|torn"),
    ],
)
def test_a_bad_log_is_refused_in_one_sentence(tmp_path: Path, lines: list[str], sentence: str) -> None:
    with pytest.raises(LogError, match=sentence) as caught:
        read_log(write(tmp_path, *lines))
    assert "\n" not in str(caught.value)


def plain(file: Path) -> None:
    file.write_text(FLASER)


def cut(file: Path) -> None:
    file.write_bytes(gzip.compress((FLASER + "\n").encode() * 2000)[:-40])


def broken(file: Path) -> None:
    data = bytearray(gzip.compress((FLASER + "\n").encode() * 2000))
    data[40:60] = b"\xff" * 20
    file.write_bytes(data)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (plain, "is not gzip though its name says so"),
        (cut, "is damaged"),
        (broken, "is damaged"),
        (lambda file: None, "cannot be read: No such file"),
        (lambda file: file.mkdir(), "cannot be read: Is a directory"),
    ],
)
def test_a_bad_file_is_refused_in_one_sentence(tmp_path: Path, make: Callable[[Path], None], sentence: str) -> None:
    file = tmp_path / "a.log.gz"
    make(file)
    with pytest.raises(LogError, match=sentence) as caught:
        read_log(file)
    assert "\n" not in str(caught.value)


def test_beams_that_a_line_cannot_tell_are_not_saved(tmp_path: Path) -> None:
    log = read_log(write(tmp_path, ROBOT))
    with pytest.raises(LogError, match="cannot be told in FLASER lines"):
        save_log(tmp_path / "b.log", log)
    assert not (tmp_path / "b.log").exists()


def front(beams: int, pose: str = "0 0 0 0 0 0", time: float = 100.0) -> str:
    return f"FLASER {beams} {'2.0 ' * (beams - 1)} 30.0 {pose} {time} host 0"


def test_more_than_361_beams_are_not_guessed(tmp_path: Path) -> None:
    file = write(tmp_path, front(541))
    with pytest.raises(LogError, match=r"a FLASER with 541 beams does not tell where they point.*--fov 240"):
        read_log(file)
    told = read_log(file, options=LogOptions(field_of_view=math.radians(270)))
    np.testing.assert_allclose(np.degrees(told.angles[[0, 1, -1]]), [-135, -134.5, 135])
    by_log = read_log(write(tmp_path, "PARAM laser_front_laser_fov 270", front(541)))
    np.testing.assert_allclose(by_log.angles, told.angles)
    by_step = read_log(write(tmp_path, "PARAM laser_front_laser_resolution 0.5", front(541)))
    np.testing.assert_allclose(by_step.angles, told.angles)


def test_the_offset_and_the_pose_of_a_front_laser_count(tmp_path: Path) -> None:
    log = read_log(write(tmp_path, "PARAM robot_frontlaser_offset 0.3", front(4)))
    assert log.mount.tolist() == [0.3, 0.0, 0.0]
    turned = read_log(write(tmp_path, front(4, f"1.0 0.3 {math.pi} 1.0 0.0 {math.pi / 2}")))
    np.testing.assert_allclose(turned.mount, [0.3, 0.0, math.pi / 2], atol=1e-9)


def test_scans_of_180_and_181_beams_are_read_and_the_rear_laser_passed_over(tmp_path: Path) -> None:
    lines = [front(180), front(181, time=100.2), front(7, time=100.3).replace("FLASER", "RLASER"), front(180, time=101)]
    log = read_log(write(tmp_path, *lines))
    assert log.ranges.shape == (3, 181) and "the beams change" in log.notes[0]


def test_odd_ranges_are_no_measurements(tmp_path: Path) -> None:
    log = read_log(write(tmp_path, "PARAM robot_front_laser_max 81.83", FLASER, FLASER.replace("1.5 2.5", "nan -1")))
    np.testing.assert_allclose(log.ranges[1], [0.0, 0.0, 3.5, 81.83])
    infinite = read_log(write(tmp_path, "PARAM robot_front_laser_max 80", FLASER.replace("2.5", "inf")))
    np.testing.assert_allclose(infinite.ranges[0], [1.5, 80.0, 3.5, 80.0])


def test_a_log_cut_in_the_middle_keeps_what_stands_before_if_asked(tmp_path: Path) -> None:
    kept = read_log(write(tmp_path, FLASER, FLASER[:30]), options=LogOptions(keep_cut=True))
    assert len(kept.ranges) == 1 and "cut off in line 2" in kept.notes[0]
    file = tmp_path / "b.log.gz"
    cut(file)
    assert "damaged or cut off" in read_log(file, options=LogOptions(keep_cut=True)).notes[0]
