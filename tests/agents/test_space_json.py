import json

import numpy as np
import pytest
from gymnasium import spaces

from lidarena.agents.space_json import from_json, to_json
from lidarena.base.errors import PolicyFileError

SPACES = [
    spaces.Box(-1.0, 1.0, (3, 2), np.float32),
    spaces.Box(np.array([0.0, -np.inf]), np.array([np.inf, 5.0]), dtype=np.float64),
    spaces.Box(0, 255, (8, 8, 1), np.uint8),
    spaces.Discrete(4, start=-1),
    spaces.MultiDiscrete([2, 3, 4]),
    spaces.MultiBinary(5),
    spaces.MultiBinary([2, 3]),
    spaces.Dict({"map": spaces.Box(0, 1, (4,), np.float32), "mask": spaces.MultiBinary(3)}),
]


@pytest.mark.parametrize("space", SPACES, ids=str)
def test_a_space_survives_json(space: spaces.Space) -> None:
    text = json.dumps(to_json(space), allow_nan=False)
    assert from_json(json.loads(text)) == space


def test_a_space_of_another_kind_is_refused() -> None:
    with pytest.raises(PolicyFileError, match="of type Text cannot be written"):
        to_json(spaces.Text(3))


@pytest.mark.parametrize(
    "torn",
    [
        {},
        {"type": "Box"},
        {"type": "Sphere"},
        {"type": "Box", "shape": [10**6, 10**6], "dtype": "float32", "low": 0, "high": 1},
        {"type": "Box", "shape": [2], "dtype": "object", "low": 0, "high": 1},
        {"type": "Discrete", "n": 0, "start": 0},
        {"type": "Dict", "spaces": [1]},
        [],
    ],
)
def test_what_describes_no_space_is_refused_in_one_sentence(torn: dict) -> None:
    with pytest.raises(PolicyFileError, match="describes no space") as refusal:
        from_json(torn)
    assert "\n" not in str(refusal.value)
