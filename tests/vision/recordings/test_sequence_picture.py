"""The picture shows the way in the plane in which the camera moves, and what was lost."""

from dataclasses import replace
from pathlib import Path

from lidarena.vision.recordings.reading import read_stereo
from lidarena.vision.recordings.sequence_odometry import SequenceResult
from lidarena.vision.recordings.sequence_picture import draw_sequence
from lidarena.vision.recordings.trajectory_errors import trajectory_errors
from tests.vision.recordings.sequences import TRUTH, write_kitti


def test_it_shows_both_ways_and_the_error_or_the_corners(tmp_path: Path) -> None:
    recording = read_stereo(write_kitti(tmp_path / "run"))
    result = SequenceResult(TRUTH, dropped=[3], tracked=[5] * 5)
    with_truth = draw_sequence(recording, result, trajectory_errors(TRUTH, TRUTH)).axes
    labels = [text.get_text() for text in with_truth[0].get_legend().get_texts()]  # type: ignore[union-attr]
    assert labels == ["truth", "odometry", "dropped frame"] and with_truth[0].get_xlabel() == "x (m)"
    assert with_truth[1].get_ylabel() == "error (m)"
    without = draw_sequence(replace(recording, truth=None), result, None).axes
    assert without[1].get_ylabel() == "corners that agree on the motion"
