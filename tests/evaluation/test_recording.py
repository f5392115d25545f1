from typing import Any

import numpy as np

from lidarena.evaluation.recording import Recording, entry_of


def recording(*infos: dict[str, Any], kept: tuple[str, ...]) -> Recording:
    made = Recording(None, None, kept)  # type: ignore[arg-type]
    for number, info in enumerate(infos):
        made.note(info)
        made.rewards += [1.0] if number else []
    return made


def test_entries_are_copied_when_they_are_noted() -> None:
    pose = np.array([1.0, 2.0, 0.5])
    made = Recording(None, None, ("pose",))  # type: ignore[arg-type]
    made.note({"pose": pose})
    pose += 1.0
    made.note({"pose": pose})
    assert made.series("pose").tolist() == [[1.0, 2.0, 0.5], [2.0, 3.0, 1.5]]
    assert made.positions("pose").tolist() == [[1.0, 2.0], [2.0, 3.0]]


def test_what_is_not_told_is_nan_beside_what_is() -> None:
    made = recording({"truth": {}}, {"truth": {"pose": [1.0, 2.0, 0.0]}}, kept=("truth.pose", "gone"))
    series = made.series("truth.pose")
    assert series.shape == (2, 3) and np.isnan(series[0]).all() and series[1].tolist() == [1.0, 2.0, 0.0]
    assert np.isnan(made.positions("gone")).all() and made.positions("gone").shape == (2, 2)


def test_steps_leave_the_reset_out_unless_there_is_nothing_else() -> None:
    assert recording({"t": 0.0}, {"t": 0.2}, {"t": 0.4}, kept=("t",)).steps_of("t").tolist() == [0.2, 0.4]
    assert recording({"t": 0.0}, kept=("t",)).steps_of("t").tolist() == [0.0]
    assert recording({"t": 0.0}, {"t": 0.2}, kept=("t",)).steps == 1


def test_a_dot_leads_into_an_entry() -> None:
    info = {"a": {"b": {"c": 3}}, "d": 4}
    assert [entry_of(info, name) for name in ("a.b.c", "d", "a.x.c", "d.e")] == [3, 4, None, None]
