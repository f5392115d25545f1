"""The keyword `reward` of every family: presets, weights, and rewards from outside of the package."""

import math
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import yaml

from lidarena.base.errors import ConfigError, RewardError
from lidarena.envs import corridor_v0
from lidarena.envs.arena.rewards import REWARDS as ARENA
from lidarena.envs.corridor.rewards import REWARDS as CORRIDOR
from lidarena.envs.exploration.rewards import REWARDS as EXPLORATION
from lidarena.envs.rewards import ChosenReward, RewardTerms, Step, choose_reward, numbers_of
from lidarena.envs.seabed.rewards import REWARDS as SEABED_REWARDS
from tests.envs.own_rewards import Careful, curious, in_parts
from tests.envs.short_seabed import SEABED

HERE = "tests.envs.own_rewards"
SHORT = {"max_episode_steps": 25}
FAMILIES: dict[str, tuple[str, dict[str, Any], RewardTerms]] = {
    "exploration": ("lidarena/Env1-v0", {"slam": "truth", **SHORT}, EXPLORATION),
    "arena": ("lidarena/Arena-v0", {"arena": "random", "density": 0.22, **SHORT}, ARENA),
    "corridor": ("lidarena/CorridorCentral-v0", {"robots": 3, **SHORT}, CORRIDOR),
    "seabed": ("lidarena/Seabed-v0", SEABED, SEABED_REWARDS),
}
Drive = list[tuple[float, dict[str, float]]]


def drive_alone(family: str, seed: int, actions: list[Any], **keywords: Any) -> Drive:
    """Rewards and terms of one world, which is reset with no seed where it ends."""
    id_, own, _ = FAMILIES[family]
    env = gym.make(id_, **own | keywords)
    env.reset(seed=seed)
    record = []
    for action in actions:
        _, reward, terminated, truncated, info = env.step(action)
        record.append((float(reward), dict(info["reward_terms"])))
        if terminated or truncated:
            env.reset()
    return record


def drive_batch(family: str, steps: int, **keywords: Any) -> tuple[list[Drive], list[Any]]:
    """The same of three worlds at once, and what they did."""
    id_, own, _ = FAMILIES[family]
    batch = gym.make_vec(id_, 3, vectorization_mode="vector_entry_point", **own | keywords)
    batch.action_space.seed(1)
    batch.reset(seed=7)
    records: list[Drive] = [[], [], []]
    taken = []
    for _ in range(steps):
        taken.append(batch.action_space.sample())
        _, rewards, terminated, truncated, infos = batch.step(taken[-1])
        for world, record in enumerate(records):
            last = infos["final_info"] if terminated[world] or truncated[world] else infos
            terms = {name: float(term[world]) for name, term in last["reward_terms"].items() if name[0] != "_"}
            record.append((float(rewards[world]), terms))
    return records, taken


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize(
    "reward",
    [curious, in_parts, Careful(5.0), f"{HERE}:in_parts", f"{HERE}:Careful"],
    ids=["function", "terms", "object", "named", "named class"],
)
def test_a_strangers_reward_pays_the_same_in_a_batch_to_the_bit(family: str, reward: Any) -> None:
    records, taken = drive_batch(family, 40, reward=reward)
    for world, record in enumerate(records):
        assert record == drive_alone(family, 7 + world, [actions[world] for actions in taken], reward=reward)
    assert len({reward for reward, _ in records[0]}) > 1
    assert all(math.isclose(reward, sum(terms.values())) for reward, terms in records[0])


@pytest.mark.parametrize("family", FAMILIES)
def test_yaml_names_it_by_its_module(family: str) -> None:
    keywords = yaml.safe_load(f"reward: '{HERE}:curious'")
    records, taken = drive_batch(family, 10, **keywords)
    alone = drive_alone(family, 7, [actions[0] for actions in taken], reward=curious)
    assert records[0] == alone and list(alone[0][1]) == ["own"]


@pytest.mark.parametrize("family", FAMILIES)
def test_weights_pay_their_terms_only_and_presets_can_be_changed(family: str) -> None:
    terms = FAMILIES[family][2]
    preset, weights = next(iter(terms.presets.items()))
    name = next(iter(weights))
    _, taken = drive_batch(family, 8)
    alone = [actions[0] for actions in taken]
    once, twice = (drive_alone(family, 7, alone, reward={name: w})[:4] for w in (1.0, 2.0))
    assert [r for r, _ in twice] == pytest.approx([2.0 * r for r, _ in once]) and list(once[0][1]) == [name]
    changed = drive_alone(family, 7, alone, reward={"preset": preset, name: weights[name]})
    assert changed == drive_alone(family, 7, alone, reward=preset)


@pytest.mark.parametrize("family", FAMILIES)
def test_the_reward_never_changes_what_is_seen_or_how_it_goes_on(family: str) -> None:
    id_, own, terms = FAMILIES[family]
    seen = []
    for reward in (*terms.presets, curious, {terms.names[0]: 3.0}):
        chosen = {"observation": "da_slam"} if family == "exploration" else {}
        batch = gym.make_vec(id_, 2, vectorization_mode="vector_entry_point", **own | chosen, reward=reward)
        batch.action_space.seed(1)
        observations = [batch.reset(seed=3)[0]]
        for _ in range(30):
            observation, _, terminated, truncated, _ = batch.step(batch.action_space.sample())
            observations += [observation, terminated, truncated]
        seen.append(np.concatenate([np.ravel(one).astype(np.float64) for one in observations]))
    assert all(np.array_equal(one, seen[0]) for one in seen)


def test_agents_of_a_team_earn_what_a_stranger_says() -> None:
    fleet = corridor_v0.parallel_env(robots=3, reward=in_parts)
    fleet.reset(seed=0)
    actions = {name: np.array([0.5, 0.5], np.float32) for name in fleet.agents}
    _, rewards, _, _, infos = fleet.step(actions)
    for robot, (name, info) in enumerate(infos.items()):
        assert info["reward_effort"] == pytest.approx(-0.01 * (1 + robot))
        assert rewards[name] == pytest.approx(info["reward_family"] + info["reward_effort"])


def test_finished_robots_earn_nothing_and_nobody_is_asked_about_them() -> None:
    ends: dict[str, Any] = {"starts": [(2.0, 7.5), (6.0, 7.5)], "goals": [(2.1, 7.5), (12.0, 7.5)], "map": "office"}
    asked: list[int] = []
    fleet = corridor_v0.parallel_env(robots=2, reward=lambda step: asked.append(step.robot) or 1.0, **ends)
    fleet.reset(seed=0)
    for _ in range(4):
        _, rewards, *_ = fleet.step({name: np.zeros(2, np.float32) for name in fleet.agents})
    assert asked == [0, 1, 1, 1, 1] and rewards == {"robot_1": 1.0}


def test_a_step_holds_what_was_told_before_and_after_it_the_map_too() -> None:
    steps: list[Step] = []
    env = gym.make("lidarena/Env1-v0", slam="truth", reward=lambda step: steps.append(step) or 0.0)
    _, info = env.reset(seed=0)
    told = [{"time": info["time"], "map": info["map"].copy()}]
    for _ in range(3):
        info = env.step(0)[4]
        told.append({"time": info["time"], "map": info["map"].copy()})
    for number, step in enumerate(steps):
        assert step.previous["time"] == told[number]["time"] and step.info["time"] == told[number + 1]["time"]
        assert np.array_equal(step.previous["map"], told[number]["map"])
        assert set(step.terms) == set(EXPLORATION.names) and step.action == 0
    assert not np.array_equal(told[0]["map"], told[-1]["map"])


@pytest.mark.parametrize("family", FAMILIES)
def test_a_saved_batch_goes_on_to_pay_the_same(family: str) -> None:
    id_, own, _ = FAMILIES[family]
    batches = [gym.make_vec(id_, 2, vectorization_mode="vector_entry_point", **own, reward=curious) for _ in range(2)]
    batches[0].action_space.seed(2)
    batches[0].reset(seed=1)
    for _ in range(6):
        batches[0].step(batches[0].action_space.sample())
    batches[1].set_state(batches[0].get_state())
    for _ in range(10):
        action = batches[0].action_space.sample()
        assert np.array_equal(*(batch.step(action)[1] for batch in batches))


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ("completenes", "reward = 'completenes' is not known; did you mean 'completeness'"),
        ({"pat": 1.0}, "unknown term 'pat' of the reward; did you mean 'path'"),
        ({"preset": "combine", "path": 1.0}, "'combine' is not known; did you mean 'combined'"),
        ({"preset": ["combined"]}, "is not known"),
        ({}, "reward = {} names no term"),
        ({"path": math.nan}, "reward.path = nan is out of range"),
        ({"path": True}, "reward.path = True is out of range"),
        (3.0, "reward = 3.0 must be a function of a step, weights by term, or one of completeness"),
        (f"{HERE}:NUMBER", "own_rewards:NUMBER' must be a function of a step"),
        (f"{HERE}:curios", "has no 'curios'; did you mean 'curious'"),
        ("no_such_module:curious", "there is no module 'no_such_module'"),
        (f"{HERE}:of_two_things", "must take one argument, the step: missing a required argument: 'other'"),
        (Step, "is a class that cannot be made without arguments"),
    ],
    ids=range(13),
)
def test_bad_rewards_are_refused_when_the_environment_is_made(spec: Any, message: str) -> None:
    with pytest.raises(ConfigError, match=message) as refusal:
        gym.make("lidarena/Env1-v0", reward=spec)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (math.nan, "gave nan"),
        (math.inf, "gave inf"),
        (None, "gave None"),
        ("much", "gave 'much'"),
        (np.zeros(2), r"gave array\(\[0., 0.\]\)"),
        ({"a": 1.0, "b": math.nan}, "gave nan for its term 'b'"),
        ({}, "a dictionary without a single term"),
    ],
    ids=range(7),
)
def test_what_is_no_number_is_refused_and_names_the_function(given: Any, message: str) -> None:
    def broken(step: Step) -> Any:
        return given

    env = gym.make("lidarena/Arena-v0", reward=broken)
    env.reset(seed=0)
    with pytest.raises(RewardError, match=message) as refusal:
        env.step(env.action_space.sample())
    assert "broken" in str(refusal.value) and "\n" not in str(refusal.value)


def test_terms_must_stay_the_same() -> None:
    env = gym.make("lidarena/Env1-v0", slam="truth", reward=lambda step: {f"at {step.info['time'] > 0.3}": 1.0})
    env.reset(seed=0)
    env.step(0)
    with pytest.raises(RewardError, match="gave the terms at True, before it was at False"):
        env.step(0)


@pytest.mark.parametrize(
    "number", [1, 1.5, np.float32(1.5), np.int64(2), np.array(3.0), True, np.bool_(0)], ids=range(7)
)
def test_numbers_of_every_kind_are_taken(number: Any) -> None:
    assert numbers_of(number, curious) == {"own": float(number)}


def test_the_weights_of_presets_are_those_of_terms_that_there_are() -> None:
    for _, _, terms in FAMILIES.values():
        for name, weights in terms.presets.items():
            assert set(weights) <= set(terms.names)
            assert choose_reward(name, terms) == ChosenReward(
                {t: weights[t] for t in terms.names if t in weights}, name
            )


OLD: list[tuple[Callable[..., Any], dict[str, Any], dict[str, Any]]] = [
    (
        lambda **keywords: gym.make("lidarena/Exploration-v0", **keywords),
        {"reward": "combined", "weights": {"path": 2.0}},
        {"reward": {"preset": "combined", "path": 2.0}},
    ),
    (
        lambda **keywords: gym.make("lidarena/Arena-v0", **keywords),
        {"turn_weight": 2.0, "time_weight": 0.0},
        {"reward": {"preset": "default", "turn": 2.0, "time": 0.0}},
    ),
    (corridor_v0.parallel_env, {"time_weight": 2.0}, {"reward": {"preset": "default", "time": 2.0}}),
]


@pytest.mark.parametrize(("make", "old", "new"), OLD, ids=["exploration", "arena", "corridor"])
def test_weights_of_version_0_1_still_weigh_and_say_how_they_are_given_now(
    make: Callable[..., Any], old: dict[str, Any], new: dict[str, Any]
) -> None:
    with pytest.warns(DeprecationWarning, match="is given as reward = .* now"):
        env = make(**old)
    assert env.unwrapped.options == make(**new).unwrapped.options


def test_weights_of_version_0_1_beside_the_reward_are_refused() -> None:
    with pytest.raises(ConfigError, match="both turn_weight and reward are given; give the weight of 'turn' in reward"):
        gym.make("lidarena/Arena-v0", reward={"turn": 1.0}, turn_weight=2.0)
    with pytest.raises(ConfigError, match="went with reward = 'combined'"):
        gym.make("lidarena/Env1-v0", reward={"path": 1.0}, weights={"path": 2.0})
