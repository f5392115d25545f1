"""One network drives every robot of a team, through either interface, and only where its robots see the same."""

import gymnasium as gym
import pytest

from lidarena import agents
from lidarena.agents.corridor.shared_fleet_agent import SharedFleetAgent
from lidarena.base.errors import PolicyFileError
from lidarena.envs import corridor_v0

KEYWORDS = {"places": "random", "neighbours": 4, "guard": True}


@pytest.fixture(scope="module")
def learned():
    return agents.load("pretrained:corridor")


def test_it_brings_pettingzoos_agents_to_their_goals(learned):
    env = corridor_v0.parallel_env(**KEYWORDS)
    policy = SharedFleetAgent(env, learned)
    arrived = 0
    for seed in (100_001, 100_002, 100_003):
        observations, infos = env.reset(seed=seed)
        policy.reset(seed)
        while env.agents:
            observations, _, _, _, infos = env.step(policy.act(observations, infos))
        arrived += int(env.episodes.arrived.sum())
    assert arrived >= 10


def test_it_drives_for_one_controller_as_well(learned):
    env = gym.make("lidarena/CorridorCentral-v0", **KEYWORDS)
    fleet = corridor_v0.parallel_env(**KEYWORDS)
    central, shared = SharedFleetAgent(env, learned), SharedFleetAgent(fleet, learned)
    observation, info = env.reset(seed=5)
    observations, infos = fleet.reset(seed=5)
    for _ in range(10):
        actions = shared.act(observations, infos)
        assert (central.act(observation, info)[0] == actions["robot_0"]).all()
        observation, _, _, _, info = env.step(central.act(observation, info))
        observations, _, _, _, infos = fleet.step(actions)


def test_robots_that_see_something_else_are_refused(learned):
    with pytest.raises(
        PolicyFileError, match=r"lidar.beams 36, but .* has lidar.beams 72; make it with lidar=.'beams': 36"
    ):
        SharedFleetAgent(corridor_v0.parallel_env(lidar={"beams": 72}, neighbours=4, guard=True), learned)
