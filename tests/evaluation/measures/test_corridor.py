from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lidarena.evaluation.measures.corridor import MEASURES
from lidarena.evaluation.recording import Recording


def recording(arrivals: list[list[bool]], collision: list[bool], **rest: Any) -> Recording:
    made = Recording(SimpleNamespace(), None, MEASURES.kept)  # type: ignore[arg-type]
    team = len(collision)
    for step, arrived in enumerate(arrivals):
        made.note({
            "time": 0.2 * step, "success": np.array(arrived), "pose": np.zeros((team, 3)),
            "collision": np.array(collision), "goal": np.ones((team, 2)), **rest,
        })  # fmt: skip
    return made


def test_a_team_is_measured_by_who_arrived_when_and_who_collided() -> None:
    made = recording(
        [[False, False], [True, False], [True, True]], [False, True], truth={"path_length": np.array([1.0, 2.5])}
    )
    assert MEASURES.measure(made) == pytest.approx({
        "path_length": 3.5, "arrival": 1.0, "all_arrived": 1.0, "collided": 0.5, "makespan": 0.4, "mean_time": 0.3
    })  # fmt: skip


def test_who_never_arrives_counts_with_the_time_at_the_end() -> None:
    values = MEASURES.measure(recording([[False, False], [True, False], [True, False]], [False, False]))
    assert values["arrival"] == 0.5 and values["all_arrived"] == 0.0
    assert values["makespan"] == pytest.approx(0.4) and values["mean_time"] == pytest.approx(0.3)
    assert np.isnan(values["path_length"])


def test_the_curve_is_the_share_that_has_arrived() -> None:
    curve = MEASURES.progress(recording([[False, False], [True, False], [True, True]], [False, False]))
    assert curve is not None


@pytest.mark.parametrize(
    ("path", "says"), [(41.23, "75% of the robots arrived in 41.2 m"), (np.nan, "75% of the robots arrived")]
)
def test_the_caption_tells_the_path_where_it_is_known(path: float, says: str) -> None:
    assert MEASURES.describe({"arrival": 0.75, "path_length": path}) == says
