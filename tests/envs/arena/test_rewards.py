"""What the terms of an arena's reward are worth."""

from types import SimpleNamespace

import numpy as np
import pytest

from lidarena.envs.arena.rewards import REWARDS, weigh_terms


def terms(**changes: object) -> dict[str, float]:
    """All terms with weight 1 of a robot that did nothing, but for ``changes``."""
    state = {"distance": 5.0, "gap": 3.0, "touched": False, "turns": 0.0, "before": 5.0, "success": False}
    state |= {"approach": 0.0} | changes
    core = SimpleNamespace(
        worlds=1, step_length=0.5, approach=1.0, turns=np.array([state["turns"]]),
        measurements=SimpleNamespace(distance=np.array([state["distance"]]), gap=np.array([state["gap"]])),
        approaches=np.array([state["approach"]]),
        physics=SimpleNamespace(touched=np.array([state["touched"]])),
    )  # fmt: skip
    ones = dict.fromkeys(REWARDS.names, 1.0)
    weighed = weigh_terms(core, ones, np.array([state["before"]]), np.array([state["success"]]))
    return {name: float(value[0]) for name, value in weighed.items()}


STILL = {"progress": 0.0, "success": 0.0, "collision": 0.0, "time": -1.0, "clearance": 0.0, "turn": 0.0, "way": 0.0}


@pytest.mark.parametrize(
    ("changes", "name", "worth"),
    [
        ({}, "time", -1.0),
        ({"distance": 4.5}, "progress", 1.0),
        ({"distance": 5.25}, "progress", -0.5),
        ({"success": True}, "success", 1.0),
        ({"touched": True}, "collision", -1.0),
        ({"gap": 0.25}, "clearance", -0.75),
        ({"gap": 0.0}, "clearance", -1.0),
        ({"approach": 0.25}, "way", 0.5),
        ({"turns": -np.pi}, "turn", -1.0),
        ({"turns": 1.5 * np.pi}, "turn", -0.5),
    ],
)
def test_each_term_pays_for_one_thing(changes: dict[str, object], name: str, worth: float) -> None:
    found = terms(**changes)
    assert found[name] == pytest.approx(worth)
    assert {other: value for other, value in found.items() if other != name} == pytest.approx(
        {other: value for other, value in STILL.items() if other != name}
    )
