"""Every family's single environment: Gymnasium's rules, refusals at the border, one meaning of every keyword."""

from inspect import Parameter, signature
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env

import lidarena
from lidarena.base.errors import ConfigError, LidarenaError
from lidarena.envs import (
    ArenaEnv,
    BatchedArena,
    BatchedCorridor,
    BatchedExploration,
    BatchedSeabed,
    CorridorCentralEnv,
    ExplorationEnv,
    SeabedEnv,
    corridor_v0,
)
from lidarena.envs.corridor.shared_env import SharedCorridor
from lidarena.envs.infos import Info

SINGLE = {
    "lidarena/Env1-v0": (ExplorationEnv, {"map": "env1", "slam": "truth"}),
    "lidarena/Arena-v0": (ArenaEnv, {"arena": "yang"}),
    "lidarena/CorridorCentral-v0": (CorridorCentralEnv, {"robots": 2}),
    "lidarena/Seabed-v0": (SeabedEnv, {"duration": 3.0, "seabeds": 1, "count": 100, "skips": [12, 25]}),
}
BATCHED = {
    "lidarena/Env1-v0": BatchedExploration,
    "lidarena/Arena-v0": BatchedArena,
    "lidarena/CorridorCentral-v0": BatchedCorridor,
    "lidarena/CorridorShared-v0": SharedCorridor,
    "lidarena/Seabed-v0": BatchedSeabed,
}
USUAL = {"lidarena/Env1-v0": 1000, "lidarena/Arena-v0": 500, "lidarena/CorridorCentral-v0": 1000}
USUAL["lidarena/Seabed-v0"] = 5000
every_id = pytest.mark.parametrize("id_", SINGLE)


def direct(id_: str, **more: Any) -> Any:
    kind, keywords = SINGLE[id_]
    return kind(**keywords | more)


@every_id
def test_gymnasiums_checker_finds_nothing(id_: str) -> None:
    check_env(direct(id_), skip_render_check=True)


@every_id
def test_options_of_reset_are_refused_since_there_are_none(id_: str) -> None:
    env = direct(id_)
    env.reset(options={})
    env.reset(options=None)
    with pytest.raises(ConfigError, match=r"options = \{'start': 1\} were given to reset\(\), which has none"):
        env.reset(options={"start": 1})


@every_id
def test_seeds_of_numpy_are_pythons(id_: str) -> None:
    env = direct(id_)
    one, _ = env.reset(seed=3)
    assert np.array_equal(one, env.reset(seed=np.int64(3))[0])
    assert np.array_equal(one, env.reset(seed=np.uint8(3))[0])
    with pytest.raises(ConfigError, match="seed = -1"):
        env.reset(seed=-1)


@every_id
def test_what_needs_an_episode_says_so(id_: str) -> None:
    env = direct(id_, render_mode="rgb_array")
    for call in (env.render, lambda: env.step(env.action_space.sample())):
        with pytest.raises(ResetNeeded, match=r"call reset\(\) first"):
            call()
    env.reset(seed=0)
    assert env.render().ndim == 3


@every_id
def test_an_ended_episode_goes_no_further_but_can_still_be_seen(id_: str) -> None:
    env = direct(id_, render_mode="rgb_array", max_episode_steps=1)
    env.reset(seed=0)
    assert any(env.step(env.action_space.sample())[2:4])
    with pytest.raises(ResetNeeded, match="has ended"):
        env.step(env.action_space.sample())
    assert env.render().ndim == 3


@every_id
@pytest.mark.parametrize("steps", ["left out", None, -1, 7])
def test_a_step_limit_means_the_same_however_the_environment_is_made(id_: str, steps: Any) -> None:
    given = {} if steps == "left out" else {"max_episode_steps": steps}
    expected = USUAL[id_] if steps in ("left out", None) else steps
    keywords = SINGLE[id_][1]
    made: Any = gym.make(id_, **keywords | given)
    assert made.unwrapped.options.max_episode_steps == -1
    assert (made.spec.max_episode_steps or -1) == expected
    assert direct(id_, **given).options.max_episode_steps == expected
    assert BATCHED[id_](1, **keywords | given).options.max_episode_steps == expected
    batch: Any = gym.make_vec(id_, 1, "vector_entry_point", **keywords | given)
    assert batch.options.max_episode_steps == expected


@pytest.mark.parametrize(("steps", "expected"), [(None, 1000), (-1, -1), (7, 7)])
def test_pettingzoo_calls_it_max_cycles(steps: int | None, expected: int) -> None:
    assert corridor_v0.parallel_env(max_cycles=steps).max_cycles == expected
    with pytest.raises(ConfigError, match="max_cycles = 0 must be a whole number"):
        corridor_v0.parallel_env(max_cycles=0)
    with pytest.raises(ConfigError, match="called 'max_cycles' here"):
        corridor_v0.parallel_env(max_episode_steps=7)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="did you mean 'max_cycles'") as refused:
        corridor_v0.parallel_env(max_cycels=7)  # type: ignore[call-arg]
    assert "max_episode_steps" not in str(refused.value)


@pytest.mark.parametrize("steps", [0, -2, 2.5, "7", True])
@every_id
def test_no_other_step_limit_is_taken(id_: str, steps: Any) -> None:
    with pytest.raises(ConfigError, match="max_episode_steps"):
        direct(id_, max_episode_steps=steps)


def ways_of_making(id_: str) -> list[Any]:
    single = [lambda **k: gym.make(id_, **k), SINGLE[id_][0]] if id_ in SINGLE else []
    return [*single, lambda **k: gym.make_vec(id_, 4, "vector_entry_point", **k), lambda **k: BATCHED[id_](4, **k)]


@pytest.mark.parametrize("id_", BATCHED)
def test_a_keyword_that_there_is_not_is_a_type_error_too(id_: str) -> None:
    """Programs that probe what a constructor takes look for these words."""
    for make in [*ways_of_making(id_), corridor_v0.parallel_env, corridor_v0.env]:
        with pytest.raises(ConfigError, match="unexpected keyword argument 'render_mod'; did you mean 'render_mode'"):
            make(render_mod="rgb_array")
        with pytest.raises(TypeError, match="unexpected keyword argument 'from_pixels'"):
            make(from_pixels=False)


@pytest.mark.parametrize("kind", [*(kind for kind, _ in SINGLE.values()), *BATCHED.values()])
def test_signatures_tell_every_keyword(kind: type) -> None:
    parameters = signature(kind).parameters
    assert {"max_episode_steps", "render_mode", "expose_truth"} <= parameters.keys()
    assert not any(one.kind == Parameter.VAR_KEYWORD for one in parameters.values())
    assert all(one.annotation is not Parameter.empty for one in parameters.values())
    assert ("autoreset_mode" in parameters) == ("num_envs" in parameters)


@pytest.mark.parametrize("make", [corridor_v0.parallel_env, corridor_v0.env, corridor_v0.raw_env])
def test_pettingzoos_signatures_tell_what_is_taken(make: Any) -> None:
    parameters = signature(make).parameters
    assert {"max_cycles", "robots"} <= parameters.keys() and "max_episode_steps" not in parameters


class Outer(gym.Env[Any, Any]):
    """An environment of one's own around one of ours."""

    def __init__(self, inner: gym.Env[Any, Any]) -> None:
        self.env = inner
        self.observation_space, self.action_space = inner.observation_space, inner.action_space

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        super().reset(seed=seed)
        return self.env.reset(seed=seed, options=options)

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, Info]:
        return self.env.step(action)


@pytest.mark.parametrize("wrap", [lambda e: e, Outer, lambda e: gym.wrappers.TimeLimit(Outer(e), 9)])
def test_baselines_find_the_environment_inside_of_others(wrap: Any) -> None:
    for env in (wrap(ExplorationEnv(map="env1")), wrap(gym.make("lidarena/Env1-v0"))):
        policy = lidarena.baselines.make("frontier", env)
        observation, info = env.reset(seed=0)
        policy.reset(seed=0)
        env.step(policy.act(observation, info))


def test_a_shared_fleet_is_no_single_environment() -> None:
    with pytest.raises(LidarenaError, match="make_vec"):
        gym.make("lidarena/CorridorShared-v0")
