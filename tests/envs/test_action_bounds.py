"""What float32 rounds beyond a bound is the bound; what is really beyond is refused."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.wrappers import RescaleAction

import lidarena  # noqa: F401
from lidarena.base.errors import ActionError
from lidarena.envs import corridor_v0
from lidarena.envs.action_bounds import ROUNDING, within_bounds

CONTINUOUS: dict[str, dict[str, Any]] = {
    "lidarena/Env1-v0": {"action": "continuous", "slam": "truth"},
    "lidarena/Arena-v0": {"arena": "yang"},
    "lidarena/CorridorCentral-v0": {"robots": 2},
}
every_family = pytest.mark.parametrize("id_", CONTINUOUS)
ROUNDED = float(np.nextafter(np.float32(1.0), np.float32(2.0)))


def test_within_the_bounds_nothing_changes() -> None:
    numbers = np.array([[-1.0, 0.3], [1.0, 1e-300]])
    assert within_bounds(numbers) is numbers


@pytest.mark.parametrize("beyond", [ROUNDED, 1.0 + 4 * np.finfo(np.float32).eps, 1.0 + ROUNDING])
def test_rounding_is_put_on_the_bound(beyond: float) -> None:
    assert np.array_equal(within_bounds(np.array([beyond, -beyond, 0.5])), [1.0, -1.0, 0.5])  # type: ignore[arg-type]


@pytest.mark.parametrize("wrong", [1.0 + 3 * ROUNDING, -1.1, np.nan, np.inf])
def test_what_is_beyond_is_not_taken(wrong: float) -> None:
    assert within_bounds(np.array([0.0, wrong])) is None


@every_family
def test_an_action_rounded_beyond_the_bound_is_the_bound(id_: str) -> None:
    one, two = (gym.make(id_, **CONTINUOUS[id_]) for _ in range(2))
    one.reset(seed=0)
    two.reset(seed=0)
    shape = one.action_space.shape
    for _ in range(3):
        first, second = one.step(np.full(shape, ROUNDED, np.float32)), two.step(np.ones(shape, np.float32))
        assert first[0].tobytes() == second[0].tobytes() and first[1] == second[1]
        assert one.observation_space.contains(first[0])
    with pytest.raises(ActionError, match=r"out of range|outside"):
        one.step(np.full(shape, 1.00001, np.float32))


@every_family
def test_a_wrapper_that_rescales_never_ends_a_training(id_: str) -> None:
    env = RescaleAction(gym.make(id_, max_episode_steps=-1, **CONTINUOUS[id_]), np.float32(0.1), np.float32(0.7))
    env.reset(seed=0)
    for k in range(20):
        bound = env.action_space.low if k % 2 else env.action_space.high  # type: ignore[attr-defined]
        if any(env.step(bound)[2:4]):
            env.reset()


def test_pettingzoo_takes_it_too() -> None:
    fleet = corridor_v0.parallel_env(robots=2)
    fleet.reset(seed=0)
    fleet.step({name: np.full(2, ROUNDED, np.float32) for name in fleet.agents})
    with pytest.raises(ActionError, match="outside of its action space"):
        fleet.step({name: np.full(2, 1.1) for name in fleet.agents})
