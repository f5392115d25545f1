from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.slam.logs.carmen import LogError
from lidarena.slam.logs.relations import Relations, check_overlap, read_relations, relation_errors
from lidarena.slam.planar import compose
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, relations_of, way

TRUTH = way(LAP, stride=0.5)
LOG = record(ring(), TRUTH)
RELATIONS = relations_of(LOG, TRUTH)


@given(st.lists(st.floats(-20, 20), min_size=3, max_size=3).map(np.array))
def test_a_true_trajectory_has_no_error_wherever_its_map_lies(shift: np.ndarray) -> None:
    errors = relation_errors(LOG.times, compose(np.broadcast_to(shift, TRUTH.shape), TRUTH), RELATIONS)
    assert errors.translation.max() < 1e-9
    assert errors.rotation.max() < 1e-7
    assert errors.unused == 0


def test_a_known_error_is_measured() -> None:
    wrong = TRUTH.copy()
    wrong[:, 0] *= 1.1
    ends = RELATIONS.times[:, :, None] == LOG.times
    x = TRUTH[ends.argmax(axis=2), 0]
    errors = relation_errors(LOG.times, wrong, RELATIONS)
    np.testing.assert_allclose(errors.translation, 0.1 * np.abs(x[:, 1] - x[:, 0]), atol=1e-9)
    assert f"{len(RELATIONS.times)} relations: translation" in str(errors)


def test_relations_beyond_the_trajectory_are_left_out_and_counted() -> None:
    half = len(LOG.times) // 2
    errors = relation_errors(LOG.times[:half], TRUTH[:half], RELATIONS)
    assert 0 < errors.unused == len(RELATIONS.times) - len(errors.translation)
    assert "more have no pose" in str(errors)


def test_another_logs_relations_are_refused() -> None:
    with pytest.raises(LogError, match=r"belong to another log than 'simulated.log': their times are 1000000000 to"):
        check_overlap(RELATIONS, LOG.times + 1e5, LOG.name)
    with pytest.raises(LogError, match="belong to another log"):
        relation_errors(LOG.times - 1e5, TRUTH, RELATIONS)


def test_relations_are_read(tmp_path: Path) -> None:
    file = tmp_path / "a.relations"
    file.write_text("# t1 t2 dx dy dz roll pitch yaw\n\n1 2 0.5 -0.5 0 0 0 0.25\n")
    relations = read_relations(file)
    assert relations.times.tolist() == [[1, 2]]
    assert relations.motions.tolist() == [[0.5, -0.5, 0.25]]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("1 2 0.5 -0.5 0 0 0 0.25\n1 2 0.5", "line 2 of relations .* is torn; eight numbers"),
        ("1 2 0.5 -0.5 0 0 0 what", "line 1 .* is torn"),
        ("1 2 0.5 -0.5 0 0 0 nan", "line 1 .* is torn"),
        ("\n# nothing\n", "holds no relations"),
        (None, "cannot be read: No such file"),
    ],
)
def test_bad_relations_are_refused(tmp_path: Path, text: str | None, sentence: str) -> None:
    file = tmp_path / "a.relations"
    if text is not None:
        file.write_text(text)
    with pytest.raises(LogError, match=sentence):
        read_relations(file)


def test_between_two_poses_a_trajectory_is_interpolated() -> None:
    times = 1e9 + 0.2 * np.arange(50)
    poses = np.column_stack([0.5 * (times - 1e9), np.zeros(50), np.zeros(50)])  # 0.5 m/s, straight on
    truth = np.array([[1e9 + 0.09, 1e9 + 5.11]])
    relations = Relations("a", truth, np.array([[0.5 * 5.02, 0.0, 0.0]]))
    assert relation_errors(times, poses, relations).translation[0] < 1e-6
