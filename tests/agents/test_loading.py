"""`agents.load(name, env)` gives a ready policy, or says in one sentence what the agent was trained for."""

from pathlib import Path
from typing import Any

import gymnasium as gym
import pytest

from lidarena import agents
from lidarena.agents.corridor.shared_fleet_agent import SharedFleetAgent
from lidarena.agents.exploration.goal_choice_agent import GoalChoiceAgent
from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.base.errors import ConfigError, PolicyFileError
from lidarena.envs import corridor_v0
from tests.agents.training_cases import small

ARENA = {"observation": "way", "action": "discrete", "guard": True, "knowledge": "lidar"}


def test_without_an_environment_it_is_the_network() -> None:
    assert all(type(agents.load(f"pretrained:{name}")) is LearnedPolicy for name in agents.pretrained())


@pytest.mark.parametrize(
    ("name", "make", "kind"),
    [
        ("arena", lambda: gym.make("lidarena/Arena-v0", **ARENA), LearnedPolicy),
        ("low_level", lambda: gym.make("lidarena/Env2-v0", observation="frontier_arcs"), LearnedPolicy),
        ("combined", lambda: gym.make("lidarena/Env2-v0"), GoalChoiceAgent),
        ("combined", lambda: gym.make("lidarena/Env2-v0", observation="map", action="continuous"), GoalChoiceAgent),
        ("combined", lambda: gym.make("lidarena/GoalChoice-v0", map="env2"), LearnedPolicy),
        ("corridor", lambda: corridor_v0.parallel_env(neighbours=4, guard=True), SharedFleetAgent),
        ("corridor", lambda: gym.make("lidarena/CorridorCentral-v0", neighbours=4, guard=True), SharedFleetAgent),
    ],
)
def test_a_ready_policy_acts_whatever_its_kind(name: str, make: Any, kind: type[Any]) -> None:
    env = make()
    policy = agents.load(f"pretrained:{name}", env)
    assert type(policy) is kind
    observation, info = env.reset(seed=3)
    policy.reset(seed=0)
    for _ in range(3):
        observation, *_, info = env.step(policy.act(observation, info))
    env.close()


class Told:
    """Drives by a network, and is told something."""

    def __init__(self, env: Any, learned: LearnedPolicy, *, preference: float = 0.5) -> None:
        self.preference = preference


def test_options_go_to_what_drives_by_the_network(monkeypatch: pytest.MonkeyPatch) -> None:
    env = gym.make("lidarena/Env2-v0")
    monkeypatch.setattr("lidarena.agents.loading.import_named", lambda *_: Told)
    told = agents.load("pretrained:combined", env, options={"preference": 0.25})
    assert isinstance(told, Told) and told.preference == 0.25
    with pytest.raises(ConfigError, match="no option 'preferense'; did you mean 'preference'"):
        agents.load("pretrained:combined", env, options={"preferense": 1})


def test_a_network_that_drives_itself_has_no_options() -> None:
    with pytest.raises(ConfigError, match="'pretrained:arena': the agent has no option 'a'; it has no options"):
        agents.load("pretrained:arena", gym.make("lidarena/Arena-v0", **ARENA), options={"a": 1})


def test_wrappers_are_looked_through() -> None:
    class Own(gym.Wrapper[Any, Any, Any, Any]):
        pass

    env = Own(gym.make("lidarena/Arena-v0", **ARENA))
    assert type(agents.load("pretrained:arena", env)) is LearnedPolicy
    with pytest.raises(PolicyFileError, match="observation 'way'"):
        agents.load("pretrained:arena", Own(gym.make("lidarena/Arena-v0", action="discrete")))


def test_an_agent_of_a_strangers_environment(tmp_path: Path) -> None:
    env_id = "tests.agents.fake_single:stranger/Walk-v0"
    folder = agents.train(small(tmp_path / "run", f"env.id={env_id}", "total_steps=64"), progress=False)
    env = gym.make(env_id)
    policy = agents.load(folder, env)
    observation, info = env.reset(seed=0)
    assert policy.act(observation, info) in (0, 1)
    with pytest.raises(PolicyFileError, match="has observations Box"):
        agents.load(folder, gym.make("CartPole-v1"))
