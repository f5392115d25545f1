"""Teams on plans of their own: drawn by each team's generator, and to be saved and continued."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import lidarena  # noqa: F401
from lidarena.base.errors import ActionError, ConfigError, TeamError
from lidarena.world.random_plans import random_plans

ROBOTS = 2


def shared(teams: int, **keywords: Any) -> Any:
    keywords = {"plans": ["random:maze", "random:rooms"], "places": "random", "max_episode_steps": 6} | keywords
    return gym.make_vec("lidarena/CorridorShared-v0", teams * ROBOTS, "vector_entry_point", robots=ROBOTS, **keywords)


def plans_of(batch: Any) -> list[str]:
    return [group.core.plan.name + str(group.core.plan.bounds) for group in batch.episodes.groups]


def drive(batch: Any, steps: int, seed: int) -> list[np.ndarray]:
    rng = np.random.default_rng(seed)
    return [batch.step(rng.uniform(-1, 1, (batch.num_envs, 2)).astype(np.float32))[0] for _ in range(steps)]


def test_every_team_is_on_a_plan_of_its_own_whoever_else_there_is() -> None:
    many, one = shared(3), shared(1)
    observations, _ = many.reset(seed=5)
    alone, _ = one.reset(seed=7)  # the third team's
    assert len(set(plans_of(many))) == 3
    assert plans_of(one) == plans_of(many)[2:]
    assert np.array_equal(observations[2 * ROBOTS :], alone)
    many.reset(seed=5)
    assert np.array_equal(many.episodes.observe(), observations)


def test_a_plan_is_left_after_some_episodes() -> None:
    batch = shared(1, episodes_per_plan=2)
    batch.reset(seed=0)
    met = [plans_of(batch)[0]]
    for _ in range(24):  # four episodes of at most six steps
        drive(batch, 1, 0)
        if plans_of(batch)[0] != met[-1]:
            met.append(plans_of(batch)[0])
    assert len(met) == 3


def test_fixed_plans_are_drawn_too() -> None:
    batch = shared(6, plans=["office", "passing"])
    batch.reset(seed=0)
    assert {group.core.plan.name for group in batch.episodes.groups} == {"office", "passing"}


def test_a_saved_batch_goes_on_to_the_bit() -> None:
    first, second = shared(2), shared(2)
    first.reset(seed=3)
    drive(first, 10, 0)
    saved = first.get_state()
    went_on = drive(first, 10, 1)
    second.set_state(saved)
    for one, other in zip(went_on, drive(second, 10, 1), strict=True):
        assert np.array_equal(one, other)


def test_no_room_for_a_team_on_any_plan_is_told() -> None:
    batch = gym.make_vec(
        "lidarena/CorridorShared-v0", 64, "vector_entry_point",
        robots=64, plans=random_plans("random:maze?area=20"), robot={"radius": 0.3},
    )  # fmt: skip
    with pytest.raises(TeamError, match="50 plans in a row have no room for 64 robots"):
        batch.reset(seed=0)


def test_a_team_moves_on_where_its_plan_turns_out_to_be_too_small(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any) -> None:
        raise TeamError("no solvable starts and goals")

    batch = shared(2, episodes_per_plan=50)
    batch.reset(seed=0)
    before = plans_of(batch)
    monkeypatch.setattr(batch.episodes.groups[1], "reset", refuse)
    drive(batch, 7, 0)
    after = plans_of(batch)
    assert after[0] == before[0]
    assert after[1] != before[1]


def test_actions_of_another_number_of_robots_are_refused() -> None:
    batch = shared(2)
    batch.reset(seed=0)
    with pytest.raises(ActionError, match=r"shape \(3, 2\) do not lead with the 4 robots"):
        batch.step(np.zeros((3, 2), np.float32))


def test_a_batch_of_controllers_cannot_tell_of_maps_of_different_shapes() -> None:
    with pytest.raises(ConfigError, match="plans is for a single team or for 'lidarena/CorridorShared-v0'"):
        gym.make_vec("lidarena/CorridorCentral-v0", 2, "vector_entry_point", robots=2, plans="random:rooms")
