"""Arenas of a generator of one's own: another in every episode, the same for a seed in any batch, saved with it."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import lidarena  # noqa: F401
from lidarena.base.errors import ConfigError, MapError
from lidarena.envs import ArenaEnv, BatchedArena, corridor_v0
from lidarena.world.arenas import Arena
from lidarena.world.floorplan import Floorplan
from tests.envs.batch_runs import raw
from tests.world.test_plan_generators import HERE, room


def scattered(rng: np.random.Generator) -> Arena:
    circles = np.column_stack([rng.uniform(20, 80, (6, 2)), rng.uniform(1, 4, 6)])
    return Arena("scattered", circles, (5.0, 5.0), (90.0, 90.0), (0.0, 0.0, 100.0, 100.0))


def growing_scale(rng: np.random.Generator) -> Arena:
    side = float(rng.choice([100.0, 10.0]))
    return Arena("scales", np.empty((0, 3)), (side / 10, side / 10), (side / 2, side / 2), (0.0, 0.0, side, side))


CASES: dict[str, dict[str, Any]] = {
    "arenas": {"arena": scattered},
    "floor plans": {"arena": f"{HERE}:room", "goal": (3.5, 0.5)},
    "with others": {"arena": [scattered, "random", "yang:u"]},
}


@pytest.mark.parametrize("case", CASES)
def test_a_seed_gives_the_same_arenas_and_bits_in_any_batch(case: str) -> None:
    keywords = CASES[case] | {"max_episode_steps": 6}
    batch = gym.make_vec("lidarena/Arena-v0", 3, "vector_entry_point", **keywords)
    _, infos = batch.reset(seed=4)
    seen = {raw(circles) for circles in infos["circles"]}
    singles = [gym.make("lidarena/Arena-v0", **keywords) for _ in range(3)]
    for k, single in enumerate(singles):
        assert raw(single.reset(seed=4 + k)[1]["circles"]) == raw(infos["circles"][k])
    for _ in range(20):
        turns = np.full((3, 1), 0.05, np.float32)
        observations, rewards, *_, infos = batch.step(turns)
        seen |= {raw(circles) for circles in infos["circles"]}
        for k, single in enumerate(singles):
            observation, reward, terminated, truncated, _ = single.step(turns[k])
            if terminated or truncated:
                observation, _ = single.reset()
            assert raw(observation) == raw(observations[k]) and reward == rewards[k]
    assert len(seen) > 4


def test_a_saved_batch_goes_on_to_the_bit() -> None:
    one, two = (
        BatchedArena(3, max_episode_steps=7, arena=scattered),
        BatchedArena(3, max_episode_steps=7, arena=scattered),
    )
    one.reset(seed=0)
    for _ in range(9):
        one.step(np.zeros((3, 1)))
    two.set_state(one.get_state())
    for _ in range(20):
        first, again = one.step(np.zeros((3, 1))), two.step(np.zeros((3, 1)))
        assert [raw(part) for part in first[:4]] == [raw(part) for part in again[:4]]


def test_by_seed_takes_the_arena_of_that_number() -> None:
    env = ArenaEnv(arena=scattered, pick="by_seed")
    first = env.reset(seed=3)[1]["circles"]
    assert np.allclose(first, scattered(np.random.default_rng(3)).circles)


@pytest.mark.parametrize("drawn", [None, 3, np.zeros((2, 3))])
def test_what_is_no_arena_is_refused(drawn: Any) -> None:
    with pytest.raises(MapError, match=r"returned an object of type .*; an Arena or a Floorplan is needed"):
        ArenaEnv(arena=lambda rng: drawn)


def test_a_floor_plan_needs_a_goal() -> None:
    with pytest.raises(MapError, match="has no goal of its own"):
        ArenaEnv(arena=room)


def test_all_arenas_of_an_environment_have_one_scale() -> None:
    env = ArenaEnv(arena=growing_scale)
    with pytest.raises(MapError, match="those of one environment must all have"):
        for seed in range(20):
            env.reset(seed=seed)


def test_a_name_that_there_is_not_is_refused() -> None:
    with pytest.raises(ConfigError, match="has no 'rooom'; did you mean 'room'"):
        ArenaEnv(arena=f"{HERE}:rooom", goal=(1, 1))
    with pytest.raises(MapError, match="arena 'yang:arch' is not known; did you mean 'yang:arc'"):
        ArenaEnv(arena="yang:arch")


@pytest.mark.parametrize("plan", [room, f"{HERE}:room"])
def test_a_team_has_one_plan_for_all_its_episodes(plan: Any) -> None:
    fleet = corridor_v0.parallel_env(map=plan, robots=2, places="random")
    expected: Floorplan = room(np.random.default_rng(0))
    for seed in range(2):
        fleet.reset(seed=seed)
        assert np.array_equal(fleet.floorplan.circles, expected.circles)
