import gzip
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.logs.carmen import LogError, RecordedLog, read_log, save_log

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
        odometry=rng.normal(0, 3, (2 * scans, 3)).round(6),
        scan_readings=readings,
        ranges=rng.uniform(0, longest, (scans, beams)).round(2).astype(np.float32),
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
        ([FLASER.replace("2.5", "nan")], "line 1 .* torn"),
        ([FLASER.replace("2.5", "-2.5")], r"line 1 .* torn: it has -2\.5 where a finite number is needed"),
        ([FLASER.replace("2.5", "1e39")], r"line 1 .* torn: it has 1e\+39 where a finite number is needed"),
        ([ROBOT.replace(" 3 4 80", " 3 1e39 80")], r"line 1 .* torn: it has 1e\+39 where a finite number is needed"),
        ([FLASER, "ODOM 1 2 3"], "line 2 .* torn: ODOM has 4 words where 10 are needed"),
        ([FLASER, "3.5 81.83 0 0 0 1 2"], "line 2 .* begins with '3.5', which is no message"),
        ([ROBOT[:60]], "line 1 .* torn"),
        ([ODOM, ODOM], "has no scans"),
        ([], "has no scans"),
        ([FLASER, FLASER.replace("FLASER 4 1.5", "FLASER 3")], "line 2 .* 3 beams .* after scans of 4 beams"),
        ([FLASER, ROBOT], "line 2 .* all scans must be alike"),
        ([FLASER.replace("1 2 0.5 100.5", "1e100 2 0.5 100.5")], r"line 1 .* torn: it has 1e\+100 where"),
        ([ODOM.replace("ODOM 1", "ODOM -1e9"), FLASER], r"line 1 .* torn: it has -1e\+09 where"),
        (
            [FLASER, *(ODOM.replace("100.0", str(100.4 - 0.4 * k)) for k in range(4))],
            "line 5 .* must not run backwards",
        ),
        (
            [FLASER, ODOM.replace("100.0", "99.0")],
            "line 2 .* is 1.5 s before a reading above it; time must not run backwards",
        ),
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
