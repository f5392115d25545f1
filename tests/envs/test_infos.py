"""What every family's infos tell by the same names, and the names of version 0.1."""

import copy
import pickle
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena.envs import corridor_v0
from lidarena.envs.infos import RENAMED, Info, masked, of_world

SCHEMA = {"pose": (3,), "collision": (), "success": (), "time": (), "path_length": (), "radius": ()}
SINGLE = {
    "exploration": ("lidarena/Env1-v0", {"slam": "truth"}),
    "arena": ("lidarena/Arena-v0", {"arena": "yang"}),
    "corridor": ("lidarena/CorridorCentral-v0", {"robots": 3}),
    "seabed": ("lidarena/Seabed-v0", {"duration": 3.0, "seabeds": 1, "count": 100, "skips": [12, 25]}),
}


def shape_of(name: str, family: str) -> tuple[int, ...]:
    a_robot = family == "corridor" and name not in ("time", "radius")
    return ((3,) if a_robot else ()) + SCHEMA[name]


def ways_of(info: dict[str, Any]) -> list[str]:
    return sorted(name for name, value in info["reward_terms"].items() if np.ndim(value) == 0)


@pytest.mark.parametrize("family", SINGLE)
def test_a_single_environment_tells_the_schema(family: str) -> None:
    id_, keywords = SINGLE[family]
    env = gym.make(id_, **keywords)
    env.action_space.seed(0)
    for info in (env.reset(seed=0)[1], env.step(env.action_space.sample())[4]):
        for name in SCHEMA:
            assert np.shape(info[name]) == shape_of(name, family), name
        assert len(ways_of(info)) >= 2 and info["reward_terms"].keys() == set(ways_of(info))


@pytest.mark.parametrize("family", SINGLE)
def test_a_batch_tells_the_schema_with_an_axis_of_worlds(family: str) -> None:
    id_, keywords = SINGLE[family]
    batch = gym.make_vec(id_, 2, vectorization_mode="vector_entry_point", **keywords)
    batch.action_space.seed(0)
    for info in (batch.reset(seed=0)[1], batch.step(batch.action_space.sample())[4]):
        for name in SCHEMA:
            assert info[name].shape == (2, *shape_of(name, family)), name
            assert info[f"_{name}"].tolist() == [True, True]
        assert all(term.shape == (2,) for name, term in info["reward_terms"].items() if not name.startswith("_"))


def test_agents_of_pettingzoo_tell_the_schema_without_dictionaries() -> None:
    fleet = corridor_v0.parallel_env(robots=3)
    _, infos = fleet.reset(seed=0)
    actions = {name: fleet.action_space(name).sample() for name in fleet.agents}
    for each in (infos, fleet.step(actions)[4]):
        for info in each.values():
            assert not any(isinstance(value, dict) for value in info.values())
            for name, shape in SCHEMA.items():
                assert np.shape(info[name]) == shape, name
            assert {f"reward_{name}" for name in info["reward_terms"]} <= set(info)
            assert info["reward_terms"]["progress"] == info["reward_progress"]


def test_names_of_version_0_1_give_their_value_and_tell_the_new_name() -> None:
    info = Info(pose=1, success=True, goal=2, collision=False, path_length=3.0, radius=0.1)
    for old, new in RENAMED.items():
        with pytest.warns(DeprecationWarning, match=f"'{old}'.* is called .*'{new}'. now"):
            assert info[old] == info[new]
        with pytest.warns(DeprecationWarning):
            assert info.get(old) == info[new]
        assert old in info


def test_masks_of_a_batch_too() -> None:
    info = masked({"success": np.array([True])}, np.array([True]))
    with pytest.warns(DeprecationWarning, match="'_arrived'"):
        assert info["_arrived"].tolist() == [True]


def test_what_never_was_is_missing() -> None:
    info = Info(pose=1)
    for name in ("arrived", "_", "nothing", "reward_terms"):
        assert name not in info and info.get(name, 7) == 7
        with pytest.raises(KeyError, match=name):
            info[name]


def test_old_names_show_up_nowhere_else() -> None:
    info = Info(pose=np.arange(3.0), success=True)
    assert list(info) == ["pose", "success"] and len(info) == 2
    for other in (pickle.loads(pickle.dumps(info)), copy.deepcopy(info), info.copy(), info | {}):
        assert type(other) is Info and list(other) == list(info) and other["success"] is True
    assert Info(success=True) == {"success": True}


def test_a_worlds_part_is_python_numbers_and_rows() -> None:
    info = {"time": np.array([1.0, 2.0]), "pose": np.arange(6.0).reshape(2, 3), "terms": {"a": np.array([3.0, 4.0])}}
    own = of_world(info, 1)
    assert own["time"] == 2.0 and type(own["time"]) is float and own["terms"] == {"a": 4.0}
    assert np.shares_memory(own["pose"], info["pose"]) and not np.shares_memory(
        of_world(info, 1, copy=True)["pose"], info["pose"]
    )


def test_exploration_succeeds_where_enough_is_known() -> None:
    env = gym.make("lidarena/Env1-v0", slam="truth", stop_at=0.2)
    _, info = env.reset(seed=0)
    assert info["success"] == (info["completeness"] >= 0.2)
    terminated = False
    while not terminated:
        _, _, terminated, _, info = env.step(1)
    assert info["success"] and not info["collision"]
