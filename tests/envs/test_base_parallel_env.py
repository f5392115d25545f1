"""What every environment for PettingZoo does alike: spaces by agent, seeds, states, pictures, refusals."""

from typing import Any

import numpy as np
import pytest
from gymnasium.error import ResetNeeded

from lidarena.base.errors import ActionError, ConfigError
from lidarena.envs import corridor_v0, workshop_v0

MADE = {"corridor": lambda **k: corridor_v0.parallel_env(robots=2, **k), "workshop": workshop_v0.parallel_env}


@pytest.fixture(params=sorted(MADE))
def make(request: pytest.FixtureRequest) -> Any:
    return MADE[request.param]


def test_spaces_are_an_agents_own_and_stay_the_same(make: Any) -> None:
    env = make()
    first, second = env.possible_agents
    for space in (env.observation_space, env.action_space):
        assert space(first) is space(first) is not space(second) and space(first) == space(second)
        with pytest.raises(ConfigError, match=f"no agent 'robt'.*{second}"):
            space("robt")


def test_numpys_whole_numbers_are_seeds_and_others_are_refused(make: Any) -> None:
    env, other = make(), make()
    seen, _ = env.reset(seed=np.int64(7))
    same, _ = other.reset(seed=7)
    assert all(np.array_equal(seen[name], same[name]) for name in env.agents)
    for bad in (-1, 0.5, "abc"):
        with pytest.raises(ConfigError, match="seed"):
            env.reset(seed=bad)


def test_nothing_goes_before_reset(make: Any) -> None:
    env = make(render_mode="rgb_array")
    for ask in (env.render, env.get_state, lambda: env.step({})):
        with pytest.raises(ResetNeeded):
            ask()


def test_a_picture_needs_a_render_mode(make: Any) -> None:
    env = make()
    env.reset(seed=0)
    with pytest.warns(UserWarning, match="render_mode='rgb_array'"):
        assert env.render() is None


def test_a_restored_world_that_was_over_has_no_agents(make: Any) -> None:
    env, other = make(max_cycles=1), make(max_cycles=1)
    env.reset(seed=0)
    waiting = {name: env.action_space(name).sample() * 0 for name in env.agents}
    env.step(waiting)
    other.reset(seed=1)
    other.set_state(env.get_state())
    assert env.agents == other.agents == []


def test_actions_are_asked_for_by_agent(make: Any) -> None:
    env = make()
    env.reset(seed=0)
    first, second = env.agents
    with pytest.raises(ActionError, match=f"action of agent '{second}' is missing"):
        env.step({first: env.action_space(first).sample()})
    with pytest.raises(ActionError, match="dictionary"):
        env.step([0, 0])


def test_keywords_are_checked(make: Any) -> None:
    with pytest.raises(ConfigError, match="called 'max_cycles'"):
        make(max_episode_steps=10)
    with pytest.raises(ConfigError, match="max_cycles = 0"):
        make(max_cycles=0)
    with pytest.raises(ConfigError, match="did you mean 'reward'"):
        make(rewrd="default")
