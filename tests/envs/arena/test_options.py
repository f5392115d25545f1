from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.envs.arena.options import LIDAR, ROBOT, ArenaOptions
from lidarena.world.arenas import load_arena


def test_the_defaults_pass() -> None:
    options = ArenaOptions.checked({})
    assert options.specs == ["random"] and options.densities == [0.15]
    assert (
        options.lidar == LIDAR
        and options.robot == ROBOT
        and options.knowledge == "map"
        and options.action == "continuous"
    )


def test_every_keyword_is_documented() -> None:
    for field in fields(ArenaOptions):
        assert f"        {field.name}: " in (ArenaOptions.__doc__ or ""), field.name


def test_one_arena_or_several() -> None:
    own = load_arena("yang")
    assert ArenaOptions.checked({"arena": own}).specs == [own]
    assert ArenaOptions.checked({"arena": ("yang", own)}).specs == ["yang", own]
    assert ArenaOptions.checked({"density": [0.1, 0.2]}).densities == [0.1, 0.2]


@pytest.mark.parametrize("name", ["progress", "success", "collision", "time", "clearance", "turn"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), "much", True])
def test_absurd_weights_are_refused(name: str, value: object) -> None:
    with pytest.raises(ConfigError, match=f"reward.{name}"):
        ArenaOptions.checked({"reward": {name: value}})


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 0.0, -2.0, "far", True])
@pytest.mark.parametrize("name", ["decision_period", "goal_radius"])
def test_absurd_lengths_and_times_are_refused(name: str, value: object) -> None:
    with pytest.raises(ConfigError, match=f"{name} = .* is out of range"):
        ArenaOptions.checked({name: value})


@pytest.mark.parametrize("density", [-0.1, 0.31, float("nan"), "0.1", [0.1, 2.0], None])
def test_absurd_densities_are_refused(density: object) -> None:
    with pytest.raises(ConfigError, match="density"):
        ArenaOptions.checked({"density": density})


@pytest.mark.parametrize(
    ("keywords", "says"),
    [
        ({"arena": "yang", "path": "barn.npz"}, "path = 'barn.npz' is for 'barn' arenas only, not for arena = 'yang'"),
        ({"arena": "u_trap", "density": 0.1}, "density = 0.1 is for 'random' arenas"),
        ({"arena": "random:5?density=0.2", "density": 0.1}, "density = 0.1 is for 'random' arenas without one"),
        ({"arena": "office", "goal": 5}, "goal = 5 must be two numbers"),
        ({"arena": "office", "goal": [[1, 2]]}, r"goal = \[\[1, 2\]\] must be two numbers"),
        ({"start": "ab"}, "start = 'ab' must be two numbers"),
    ],
)
def test_what_no_arena_would_look_at_is_refused(keywords: dict[str, Any], says: str) -> None:
    with pytest.raises(ConfigError, match=says) as refusal:
        ArenaOptions.checked(keywords)
    assert "\n" not in str(refusal.value)


def test_what_one_of_several_arenas_looks_at_is_allowed() -> None:
    ArenaOptions.checked({"arena": ["yang", "barn:4"], "path": "barn.npz"})
    ArenaOptions.checked({"arena": ["u_trap", "random:5"], "density": 0.1, "goal": np.array([50, 60])})


def test_files_may_be_given_as_paths() -> None:
    options = ArenaOptions.checked({"arena": "barn", "path": Path("barn.npz")})
    assert options.path == "barn.npz"
    assert ArenaOptions.checked({"arena": Path("hall.yaml"), "goal": (1, 2)}).specs == ["hall.yaml"]
