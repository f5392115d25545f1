"""The workshop in which both decide: PettingZoo's own tests, and who may do what."""

import warnings

import numpy as np
import pytest

import lidarena  # noqa: F401

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # PettingZoo's tests import its own old environments
    from pettingzoo.test import api_test, max_cycles_test, parallel_api_test, parallel_seed_test

from lidarena.base.errors import ActionError, ConfigError
from lidarena.envs import workshop_v0
from lidarena.envs.workshop.observations import PER_ACTION
from tests.envs.workshop.workshops import action, chain, loose, task_of


@pytest.mark.filterwarnings("ignore:We recommend agents to be named")  # as player_0
def test_pettingzoos_tests_are_passed(capsys: pytest.CaptureFixture[str]) -> None:
    parallel_api_test(workshop_v0.parallel_env(), 60)
    api_test(workshop_v0.env(), num_cycles=60)
    parallel_seed_test(lambda: workshop_v0.parallel_env(task="gearbox"), 30)
    max_cycles_test(workshop_v0)


def test_both_decide_and_who_is_busy_can_only_go_on() -> None:
    env = workshop_v0.parallel_env(task=loose(3))
    seen, infos = env.reset(seed=0)
    assert set(seen) == {"human", "robot"} and env.observation_space("human").contains(seen["human"])
    assert infos["human"]["action_mask"].tolist() == infos["robot"]["action_mask"].tolist() == [1, 1, 1, 0]
    _, rewards, *_, infos = env.step({"human": 0, "robot": 2})
    assert infos["human"]["agent"].tolist() == [0, -1, 1] and rewards["human"] == rewards["robot"] < 0
    busy = "human" if infos["human"]["doing"][0] >= 0 else "robot"
    assert infos[busy]["action_mask"].tolist() == [0, 0, 0, 1]
    while env.agents:
        *_, infos = env.step({name: int(np.argmax(infos[name]["action_mask"])) for name in env.agents})
    assert infos["human"]["success"] and infos["human"]["reward_time"] < 0


def test_where_both_want_the_same_the_human_does_it() -> None:
    env = workshop_v0.parallel_env(task=loose(3))
    env.reset(seed=0)
    *_, infos = env.step({"human": 1, "robot": 1})
    assert infos["human"]["agent"][1] == 0 and infos["human"]["refused"] == 1


def test_a_human_may_break_the_order() -> None:
    env = workshop_v0.parallel_env(task=chain(2))
    env.reset(seed=0)
    *_, infos = env.step({"human": 1, "robot": 2})
    assert infos["human"]["unplanned"] == 1 and infos["human"]["agent"][1] == 0


def test_a_saved_environment_goes_on_to_the_bit() -> None:
    env, other = (workshop_v0.parallel_env(task="gearbox") for _ in range(2))
    env.reset(seed=3)
    env.step({"human": 1, "robot": 0})
    other.reset(seed=4)
    other.set_state(env.get_state())
    first, second = (one.step({"human": 10, "robot": 10})[0]["robot"] for one in (env, other))
    assert np.array_equal(first, second) and env.state().shape == (2, len(first))


def test_the_agent_sees_itself_as_the_robot() -> None:
    env = workshop_v0.parallel_env(task=task_of({"x": action("a", robot=None), "y": action("d", human=None)}))
    seen, _ = env.reset(seed=0)
    human, robot = (seen[name][: 2 * PER_ACTION].reshape(2, -1) for name in ("human", "robot"))
    assert human[0, 3:5].tolist() == robot[1, 3:5].tolist() == [1, 0]


@pytest.mark.parametrize(
    ("actions", "message"),
    [({"human": 0}, "'robot' is missing"), ({"human": 0, "robto": 0}, "'robto'"), (3, "dictionary"),
     ({"human": 0, "robot": 9}, "out of range"), ({"human": 0.5, "robot": 1}, "whole numbers")],
)  # fmt: skip
def test_bad_actions_are_refused(actions: object, message: str) -> None:
    env = workshop_v0.parallel_env(task=loose(2))
    env.reset(seed=0)
    with pytest.raises(ActionError, match=message):
        env.step(actions)


@pytest.mark.parametrize("keywords", [{"human": "free"}, {"max_episode_steps": 3}, {"max_cycles": 0}, {"taks": 1}])
def test_bad_keywords_are_refused(keywords: dict[str, object]) -> None:
    with pytest.raises(ConfigError):
        workshop_v0.parallel_env(**keywords)
