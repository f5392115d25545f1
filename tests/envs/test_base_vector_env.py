"""The native batches keep to Gymnasium's rules: autoreset in every mode, reset masks, options, rendering, state."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from lidarena.base.errors import ConfigError
from lidarena.envs.infos import row_of
from tests.envs.short_seabed import SEABED

CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "exploration": ("lidarena/Env1-v0", {"slam": "truth", "start": "random", "max_episode_steps": 9}),
    "map": ("lidarena/Env1-v0", {"slam": "truth", "observation": "map", "max_episode_steps": 4}),
    "choices": (
        "lidarena/GoalChoice-v0",
        {"map": "maze:5?width=4&height=4", "start": "random", "slam": "truth", "candidates": 4, "max_episode_steps": 4},
    ),
    "arena": ("lidarena/Arena-v0", {"density": 0.25, "max_episode_steps": 7, "knowledge": "lidar"}),
    "corridor": (
        "lidarena/CorridorCentral-v0",
        {"robots": 2, "robot": {"radius": 0.3}, "places": "random", "max_episode_steps": 6},
    ),
    "seabed": ("lidarena/Seabed-v0", SEABED),
}
every_family = pytest.mark.parametrize("case", CASES)
every_mode = pytest.mark.parametrize("mode", list(AutoresetMode))


def native(case: str, worlds: int = 3, **more: Any) -> gym.vector.VectorEnv:
    id_, keywords = CASES[case]
    return gym.make_vec(id_, worlds, "vector_entry_point", **keywords | more)


def reference(case: str, mode: AutoresetMode, worlds: int = 3) -> gym.vector.VectorEnv:
    id_, keywords = CASES[case]
    return SyncVectorEnv([lambda: gym.make(id_, **keywords)] * worlds, autoreset_mode=mode)


def same(one: Any, two: Any) -> None:
    if isinstance(one, dict):
        assert one.keys() == two.keys()
        for name in one:
            same(one[name], two[name])
    else:
        assert np.array_equal(one, two), (one, two)


def same_infos(one: dict[str, Any], two: dict[str, Any], rows: Any = slice(None)) -> None:
    names = [name for name in two if not name.startswith(("_", "final_"))]
    assert names
    for name in names:
        if isinstance(two[name], dict):
            same_infos(one[name], two[name], rows)
        else:
            assert np.array_equal(one[name][rows], two[name][rows]), name


@every_mode
@every_family
def test_a_batch_behaves_as_gymnasiums_own_of_the_same_environments(case: str, mode: AutoresetMode) -> None:
    batch, expected = native(case, autoreset_mode=mode), reference(case, mode)
    batch.action_space.seed(4)
    same(batch.reset(seed=11)[0], expected.reset(seed=11)[0])
    ends = 0
    for _ in range(30):
        actions = batch.action_space.sample()
        one, two = batch.step(actions), expected.step(actions)
        same(one[0], two[0])
        for k in (1, 2, 3):
            assert np.array_equal(one[k], two[k])
            assert one[k].dtype == two[k].dtype
        same_infos(one[4], two[4])
        done = one[2] | one[3]
        ends += int(done.sum())
        if mode == AutoresetMode.SAME_STEP and done.any():
            assert np.array_equal(one[4]["_final_obs"], two[4]["_final_obs"])
            two[4]["final_info"].pop("map", None)  # a batch does not copy whole maps of episodes that are over
            same_infos(one[4]["final_info"], two[4]["final_info"], done)
            for k in np.flatnonzero(done):
                same(one[4]["final_obs"][k], two[4]["final_obs"][k])
        if mode == AutoresetMode.DISABLED and done.any():
            same(batch.reset(options={"reset_mask": done})[0], expected.reset(options={"reset_mask": done.copy()})[0])
    assert ends > 6


@every_family
def test_a_reset_mask_leaves_the_other_worlds_alone_to_the_bit(case: str) -> None:
    batch, twin = native(case), native(case)
    mask = np.array([False, True, False])
    for envs in (batch, twin):
        envs.action_space.seed(1)
        envs.reset(seed=3)
        envs.step(envs.action_space.sample())
    before = batch.get_state()  # type: ignore[attr-defined]
    _, infos = batch.reset(options={"reset_mask": mask}, seed=50)
    after = batch.get_state()  # type: ignore[attr-defined]
    assert np.array_equal(infos["_time"], mask) and infos["time"][1] == 0
    for name, array in before.items():
        if len(array) == 3:
            assert array[[0, 2]].tobytes() == after[name][[0, 2]].tobytes(), name
    actions = batch.action_space.sample()
    one, two = batch.step(actions), twin.step(actions)
    for k in (0, 2):
        same(row_of(one[0], k), row_of(two[0], k))
    observations, _ = batch.reset(seed=50, options={"reset_mask": mask})
    same(row_of(observations, 1), row_of(native(case, 1).reset(seed=51)[0], 0))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"reset_mask": [True, False]}, "3 truth values"),
        ({"reset_mask": np.zeros(3, bool)}, "one of them True"),
        ({"reset_mask": np.array([1, 0, 0])}, "truth values"),
        ({"reset_mask": None}, "truth values"),
        ({"reset_masks": np.ones(3, bool)}, "did you mean 'reset_mask'"),
        ({"start": (0, 0)}, "unknown option 'start'"),
    ],
)
def test_other_options_are_refused(options: dict[str, Any], message: str) -> None:
    batch = native("exploration")
    batch.reset(seed=0)
    with pytest.raises(ConfigError, match=message):
        batch.reset(options=options)


def test_a_mask_needs_running_episodes() -> None:
    with pytest.raises(ResetNeeded, match="without one first"):
        native("exploration").reset(options={"reset_mask": np.array([True, False, False])})
    batch = native("exploration")
    batch.reset(options={"reset_mask": np.ones(3, bool)}, seed=0)
    assert np.array_equal(batch.step(np.zeros(3, int))[2], np.zeros(3, bool))


def test_robots_of_one_team_are_reset_together() -> None:
    shared = gym.make_vec("lidarena/CorridorShared-v0", 4, "vector_entry_point", robots=2)
    shared.reset(seed=0)
    with pytest.raises(ConfigError, match="same for all robots of a team"):
        shared.reset(options={"reset_mask": np.array([True, False, False, False])})
    shared.reset(options={"reset_mask": np.array([True, True, False, False])})


def test_the_seed_of_a_masked_reset_is_not_taken_by_the_others() -> None:
    batch, twin = native("exploration"), native("exploration")
    for envs in (batch, twin):
        envs.reset(seed=7)
    mask = np.array([True, False, False])
    batch.reset(seed=[1, 2, 3], options={"reset_mask": mask})
    same(batch.reset()[0][1:], twin.reset()[0][1:])


@pytest.mark.parametrize("give", [lambda s: s, tuple, np.array, lambda s: [np.int64(one) for one in s]])
def test_one_seed_a_world_in_any_sequence(give: Callable[[list[int]], Any]) -> None:
    batch = native("exploration")
    observations, _ = batch.reset(seed=give([5, 9, 2]))
    for world, seed in enumerate([5, 9, 2]):
        assert np.array_equal(observations[world], native("exploration", 1).reset(seed=seed)[0][0])
    assert np.array_equal(batch.reset(seed=np.int32(5))[0][0], observations[0])


@every_mode
def test_the_mode_is_an_attribute_and_in_the_metadata(mode: AutoresetMode) -> None:
    for spelled in (mode, mode.value, mode.name, mode.name.lower()):
        batch: Any = native("exploration", autoreset_mode=spelled)
        assert batch.autoreset_mode is mode and batch.metadata["autoreset_mode"] is mode
    assert native("exploration").metadata["autoreset_mode"] is AutoresetMode.SAME_STEP


@pytest.mark.parametrize("mode", ["NextStp", None, ["NextStep"], 1])
def test_a_mode_that_there_is_not_is_refused(mode: Any) -> None:
    with pytest.raises(ConfigError, match="autoreset_mode"):
        native("exploration", autoreset_mode=mode)


def test_without_autoreset_an_ended_episode_must_be_reset_first() -> None:
    batch = native("exploration", autoreset_mode="Disabled", start=None, max_episode_steps=2)
    batch.reset(seed=0)
    batch.step(np.ones(3, int))
    batch.reset(options={"reset_mask": np.array([True, False, True])})
    assert batch.step(np.ones(3, int))[3].tolist() == [False, True, False]
    with pytest.raises(ResetNeeded, match="environment 1 has ended"):
        batch.step(np.ones(3, int))
    batch.reset(options={"reset_mask": np.array([False, True, False])})
    assert batch.step(np.ones(3, int))[3].tolist() == [True, False, True]


def test_under_next_step_the_action_of_an_ended_episode_is_not_looked_at() -> None:
    batch = native("exploration", autoreset_mode="NextStep", action="continuous", start=None, max_episode_steps=1)
    batch.reset(seed=0)
    still = np.full((3, 2), [-1.0, 0.0])
    assert batch.step(still)[3].all()
    _, rewards, terminated, truncated, infos = batch.step(np.full((3, 2), np.nan))
    assert not rewards.any() and not terminated.any() and not truncated.any() and not infos["time"].any()
    assert batch.step(still)[3].all()


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.DISABLED])
def test_a_saved_batch_knows_which_episodes_have_ended(mode: AutoresetMode) -> None:
    keywords = {"autoreset_mode": mode, "start": None, "max_episode_steps": 3}
    batch, other = native("exploration", **keywords), native("exploration", **keywords)
    batch.reset(seed=0)
    other.reset(seed=1)
    for _ in range(3):
        batch.step(np.ones(3, int))
    other.set_state(batch.get_state())  # type: ignore[attr-defined]
    if mode == AutoresetMode.DISABLED:
        with pytest.raises(ResetNeeded, match="has ended"):
            other.step(np.ones(3, int))
        return
    for _ in range(9):
        one, two = batch.step(np.ones(3, int)), other.step(np.ones(3, int))
        for k in range(4):
            assert np.array_equal(one[k], two[k])


@every_family
def test_what_needs_an_episode_says_so(case: str) -> None:
    batch: Any = native(case, render_mode="rgb_array")
    for call in (batch.render, batch.get_state, lambda: batch.step(batch.action_space.sample())):
        with pytest.raises(ResetNeeded, match=r"reset\(\)"):
            call()
    batch.reset(seed=0)
    assert len(batch.render()) == 3


def test_versions_whose_statistics_are_wrong_under_same_step_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gym, "__version__", "1.3.0")
    with pytest.warns(UserWarning, match=r"gymnasium 1.3.0 count one step .* autoreset_mode='NextStep'"):
        native("exploration")
    native("exploration", autoreset_mode="NextStep")
    native("exploration", autoreset_mode="Disabled")
