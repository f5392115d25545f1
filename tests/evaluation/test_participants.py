"""Making environments and policies, and the sentences for what does not exist."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import gymnasium as gym
import pytest
from gymnasium import spaces

from lidarena import agents, baselines
from lidarena.base.errors import ConfigError, PolicyFileError
from lidarena.base.yaml_config import check_config
from lidarena.evaluation.comparison_config import ComparisonConfig, EnvEntry, PolicyEntry
from lidarena.evaluation.participants import check, make_env, make_participants
from tests.evaluation.fake_world import Corridor, Driver

HERE = "tests.evaluation.fake_world"
CORRIDOR = EnvEntry(id=f"{HERE}:fake/Corridor-v0", keywords={"slip": 0.1, "reward": "completeness"})


def the_corridor(env: gym.Env[Any, Any]) -> Corridor:
    assert isinstance(env.unwrapped, Corridor)
    return env.unwrapped


def test_a_policy_of_ones_own_gets_environment_and_options() -> None:
    entry = PolicyEntry(name=f"{HERE}:Driver", options={"back": 0.4}, keywords={"stop_at": 0.5})
    env, policy = make_participants(CORRIDOR, entry)
    assert isinstance(policy, Driver) and policy.back == 0.4
    assert the_corridor(env).keywords | {"slip": 0.1, "stop_at": 0.5} == the_corridor(env).keywords
    assert the_corridor(env).expose_truth


def test_a_baseline_is_made_by_name() -> None:
    env, policy = make_participants(CORRIDOR, PolicyEntry(name="random"))
    assert isinstance(policy, type(baselines.make("random", env)))


def fake_agent(monkeypatch: pytest.MonkeyPatch, **attributes: Any) -> PolicyEntry:
    agent = SimpleNamespace(reset=lambda seed=None: None, act=lambda observation, info: 0, env_keywords={}, env_id="")
    agent.action_space, agent.ask_for_masks = spaces.Discrete(3), lambda env: None
    agent.observation_space = make_env(CORRIDOR.id, {}).observation_space
    vars(agent).update(attributes)
    monkeypatch.setattr(agents, "load", lambda path: agent, raising=False)
    return PolicyEntry(name="trained", path=str(Path(__file__).parent))


def test_an_agent_brings_the_keywords_that_its_inputs_depend_on(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = fake_agent(monkeypatch, env_keywords={"observation": "map", "reward": "d_optimality", "slip": 7.0})
    env, _ = make_participants(CORRIDOR, entry)
    assert the_corridor(env).keywords["observation"] == "map"
    assert the_corridor(env).keywords["reward"] == "completeness"  # episodes are worth the same to everybody
    assert the_corridor(env).keywords["slip"] == 0.1  # the world is the comparison's


def test_an_agent_trained_with_a_default_gets_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    other = EnvEntry(id=CORRIDOR.id, keywords={"observation": "map"})
    env, _ = make_participants(other, fake_agent(monkeypatch))
    assert the_corridor(env).keywords["observation"] == "da_slam"


def test_an_agent_of_other_actions_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = fake_agent(monkeypatch, action_space=spaces.Discrete(5))
    with pytest.raises(PolicyFileError, match=r"'trained' was trained .*Discrete\(5\).* actions Discrete\(3\)"):
        make_participants(CORRIDOR, entry)


@pytest.mark.parametrize(
    ("policy", "sentence"),
    [
        ({"name": "randon"}, "there is no policy 'randon'; did you mean 'random'"),
        ({"name": "mine", "path": "runs/nowhere"}, "policy 'mine': there is no 'runs/nowhere'"),
        ({"name": f"{HERE}:Drivr"}, "did you mean 'Driver'"),
        ({"name": "no_such_module:Driver"}, "there is no module 'no_such_module'"),
    ],
)
def test_policies_that_do_not_exist_are_refused_before_anything_runs(policy: dict, sentence: str) -> None:
    config = check_config({"envs": [CORRIDOR.id], "policies": [policy]}, ComparisonConfig)
    with pytest.raises(ConfigError) as caught:
        check(config)
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("env_id", "sentence"),
    [
        (f"{HERE}:fake/Coridor-v0", "did you mean 'fake/Corridor-v0'"),
        ("no_such_module:fake/Corridor-v0", "there is no module 'no_such_module'"),
        ("nonsense", "there is no environment 'nonsense'"),
        ("a/b/c-v0", "there is no environment 'a/b/c-v0'"),
    ],
)
def test_environments_that_do_not_exist_are_refused(env_id: str, sentence: str) -> None:
    with pytest.raises(ConfigError) as caught:
        check(check_config({"envs": [env_id], "policies": ["random"]}, ComparisonConfig))
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("policy", "sentence"),
    [
        ({"name": f"{HERE}:mute"}, "made 'object', which lacks reset"),
        ({"name": f"{HERE}:Driver", "options": {"backwards": 1}}, "unexpected keyword argument 'backwards'"),
    ],
)
def test_policies_that_cannot_be_made_are_refused(policy: dict, sentence: str) -> None:
    with pytest.raises(ConfigError) as caught:
        make_participants(CORRIDOR, PolicyEntry(**policy))
    assert sentence in str(caught.value) and "\n" not in str(caught.value)


def test_a_misspelt_keyword_is_refused() -> None:
    with pytest.raises(ConfigError, match="'slipp'; did you mean 'slip'"):
        make_env(CORRIDOR.id, {"slipp": 0.1})


def test_an_environment_that_takes_no_truth_is_made_without() -> None:
    env = make_env("CartPole-v1", {"max_episode_steps": 7})
    assert env.spec is not None and env.spec.max_episode_steps == 7


def test_an_environment_that_cannot_be_made_is_refused_in_one_sentence() -> None:
    with pytest.raises(ConfigError, match=r"^environment 'CartPole-v1' cannot be made: .*unexpected.*'mass'") as caught:
        make_env("CartPole-v1", {"mass": 3})
    assert "expose_truth" not in str(caught.value) and "\n" not in str(caught.value)
