"""The observation ``"way"``: the way through what was seen, how long headings stay free, and what the way pays."""

import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from hypothesis import given
from hypothesis import strategies as st

import lidarena
from lidarena.envs import ArenaEnv, BatchedArena
from lidarena.envs.arena.known_way import EXTRAS, HORIZON, time_to_meet
from lidarena.world.arenas import Arena
from lidarena.world.walled_arenas import posts_along

ROOM = (0.0, 0.0, 100.0, 100.0)
EMPTY = Arena("empty", np.empty((0, 3)), (10.0, 50.0), (90.0, 50.0), ROOM, 1.0)
WALL = Arena("wall", posts_along([(50.0, 30.0), (50.0, 80.0)]), (10.0, 50.0), (90.0, 50.0), ROOM, 1.0)
CORNER = Arena("pocket", posts_along([(38.0, 62.0), (50.0, 62.0), (50.0, 38.0), (38.0, 38.0)]), (10.0, 50.0),
               (90.0, 50.0), ROOM, 1.0)  # fmt: skip


def made(arena: Any, **keywords: Any) -> ArenaEnv:
    return ArenaEnv(arena=arena, observation="way", knowledge="lidar", **keywords)


def towards(env: ArenaEnv, info: dict[str, Any]) -> np.ndarray:
    """The action that drives at the lookahead point."""
    x, y = info["lookahead_point"] - info["pose"][:2]
    return np.array([math.remainder(math.atan2(y, x) - info["pose"][2], 2 * math.pi) / math.pi], np.float32)


def follow(env: ArenaEnv, steps: int) -> tuple[list[dict[str, Any]], list[float]]:
    """Drive at the lookahead point; the infos, and what the steps paid."""
    _, info = env.reset(seed=0)
    infos, rewards = [info], []
    for _ in range(steps):
        _, reward, terminated, _, info = env.step(towards(env, info))
        infos.append(info)
        rewards.append(float(reward))
        if terminated:
            break
    return infos, rewards


@pytest.mark.parametrize("keywords", [{"arena": "random"}, {"arena": "gnron"}, {"arena": "env2", "goal": (1.0, 6.5)}])
def test_environments_that_show_a_way_pass_the_checker(keywords: dict[str, Any]) -> None:
    check_env(gym.make("lidarena/Arena-v0", observation="way", **keywords).unwrapped)


def test_in_an_empty_room_the_way_is_the_straight_one() -> None:
    env = made(EMPTY)
    observation, info = env.reset(seed=0)
    assert info["way_length"] == pytest.approx(80.0, abs=1.0)
    assert math.atan2(*(info["lookahead_point"] - info["pose"][:2])[::-1]) == pytest.approx(0.0, abs=0.1)
    assert observation.shape == (36 + 3 + EXTRAS,)
    assert observation[39:42] == pytest.approx([80.0 / 150.0, 1.0, 0.0], abs=0.1)
    infos, _ = follow(env, 100)
    assert infos[-1]["success"] and infos[-1]["path_length"] == pytest.approx(79.0, abs=1.0)


def test_the_first_numbers_are_those_of_proximity() -> None:
    way, plain = made(WALL), ArenaEnv(arena=WALL, observation="proximity")
    way.reset(seed=0), plain.reset(seed=0)
    for turn in (0.1, -0.3, 0.2):
        action = np.array([turn], np.float32)
        assert np.array_equal(way.step(action)[0][:39], plain.step(action)[0])


@pytest.mark.parametrize("arena", [WALL, CORNER], ids=["wall", "pocket"])
def test_the_way_leads_around_what_was_seen_and_is_followed_to_the_goal(arena: Arena) -> None:
    infos, _ = follow(made(arena), 300)
    assert infos[0]["way_length"] == pytest.approx(80.0, abs=1.0)  # the wall is 40 m away: not seen yet
    assert max(info["way_length"] + info["path_length"] for info in infos) > 85.0
    if arena is CORNER:  # who only follows the point grazes the end of the wall
        assert infos[-1]["success"]


def test_nothing_that_was_not_seen_makes_a_difference() -> None:
    far = Arena("far", posts_along([(85.0, 5.0), (85.0, 95.0)]), (10.0, 50.0), (90.0, 50.0), ROOM, 1.0)
    infos, others = (follow(made(arena), 30)[0] for arena in (EMPTY, far))
    for info, other in zip(infos, others, strict=True):
        assert np.array_equal(info["lookahead_point"], other["lookahead_point"])
        assert info["way_length"] == other["way_length"]


@given(
    st.floats(-9, 9), st.floats(-9, 9), st.floats(-2, 2), st.floats(-2, 2), st.floats(0.1, 2.0)
)  # fmt: skip
def test_the_time_to_meet_is_that_of_many_small_steps(x: float, y: float, vx: float, vy: float, radius: float) -> None:
    times = np.linspace(0.0, 12.0, 6001)
    away = np.hypot(x - times * vx, y - times * vy)
    found = time_to_meet(x, y, vx, vy, radius)
    if away[0] <= radius:
        assert found in (0.0, math.inf)  # met already, unless it draws away
        return
    met = np.flatnonzero(away < radius - 1e-6)
    if len(met):
        assert found <= times[met[0]] + 1e-9
    if found < 12.0:
        assert np.hypot(x - found * vx, y - found * vy) == pytest.approx(radius, abs=1e-6)


def test_a_heading_is_as_free_as_what_lies_on_it_allows() -> None:
    pillar = Arena("pillar", np.array([[20.0, 50.0, 4.0]]), (10.0, 50.0), (90.0, 50.0), ROOM, 1.0)
    env = made(pillar)
    observation, _ = env.reset(seed=0)
    free = env.episodes.core.known.ways.free[0]
    assert free[0] == pytest.approx(20.0 - 4.0 - 1.0 - 10.0, abs=0.1)  # the pillar begins 6 m ahead
    assert free[4] == free[8] == free[12] == HORIZON
    assert observation[42] == pytest.approx((HORIZON - free[0]) / (HORIZON * (1.0 + free[0])))
    assert observation[46] == observation[50] == 0.0


def test_what_comes_along_is_met_sooner_than_what_stands() -> None:
    env = made(EMPTY, moving={"number": 1, "speed": 1.0})
    env.reset(seed=0)
    core = env.episodes.core
    for k in range(4):
        core.moving.states[0, 0] = 26.0 - k, 50.0, -1.0, 0.0
        env.step(np.zeros(1, np.float32))
    gap = core.moving.states[0, 0, 0] - 3.0 - core.physics.poses[0, 0, 0] - 1.0
    assert core.known.ways.free[0, 0] == pytest.approx(gap / 2.0, abs=0.5)
    assert core.known.ways.free[0, 8] == HORIZON  # what follows no faster than the robot flees never meets it


def test_what_moves_does_not_stay_in_the_map() -> None:
    env = made(EMPTY, moving={"number": 1, "speed": 0.5})
    env.reset(seed=0)
    core = env.episodes.core
    for k in range(120):
        core.moving.states[0, 0] = (25.0, 35.0 + 0.7 * k, 0.0, 0.7) if k < 40 else (90.0, 90.0, 0.0, 0.0)
        env.step(np.array([0.27], np.float32))  # round and round
    x, y = core.known.seen.points[0][core.known.seen.trust[0] > 0].T
    inside = (x > 2.0) & (x < 40.0) & (y > 20.0) & (y < 60.0)
    assert inside.sum() <= 4


@pytest.mark.parametrize("arena", [WALL, CORNER], ids=["wall", "pocket"])
def test_the_way_pays_for_getting_nearer_and_never_for_finding_out_that_it_is_longer(arena: Arena) -> None:
    infos, rewards = follow(made(arena, reward={"way": 1.0}), 300)
    assert max(rewards) <= 1.0 + 1e-9
    lengths = np.array([info["way_length"] for info in infos])
    longer = np.diff(lengths) > 2.0
    assert longer.any()
    paid = np.array(rewards)
    assert (paid[longer] <= 1.0 + 1e-9).all()
    assert paid.sum() <= infos[-1]["path_length"] + 1e-6


def test_driving_in_a_circle_pays_nothing() -> None:
    env = made(EMPTY, reward={"way": 1.0})
    env.reset(seed=0)
    paid = sum(float(env.step(np.array([0.25], np.float32))[1]) for _ in range(80))  # ten rounds
    assert abs(paid) < 1.0


def test_a_reward_for_the_way_changes_no_observation() -> None:
    plain, paid = (ArenaEnv(arena=WALL, reward=reward) for reward in ("default", {"way": 1.0}))
    plain.reset(seed=0), paid.reset(seed=0)
    one, other = (env.step(np.zeros(1, np.float32)) for env in (plain, paid))
    assert np.array_equal(one[0], other[0]) and other[1] == pytest.approx(1.0, abs=0.1)
    assert "lookahead_point" in other[4] and "lookahead_point" not in one[4]


def test_a_world_of_a_batch_knows_what_it_knows_alone() -> None:
    keywords = {"arena": "random", "density": 0.2, "moving": {"number": 4}, "observation": "way"}
    batch = BatchedArena(3, **keywords)
    alone = ArenaEnv(**keywords)
    rows, _ = batch.reset(seed=5)
    row, _ = alone.reset(seed=6)
    assert np.array_equal(rows[1], row)
    for turn in (0.1, 0.3, -0.2, 0.0, 0.4):
        rows, *_ = batch.step(np.full((3, 1), turn, np.float32))
        row, _, terminated, *_ = alone.step(np.full(1, turn, np.float32))
        if terminated:
            break
        assert np.array_equal(rows[1], row)


def test_what_is_saved_goes_on_to_the_bit() -> None:
    keywords = {"arena": "random", "moving": {"number": [0, 4]}, "observation": "way"}
    one, other = BatchedArena(2, **keywords), BatchedArena(2, **keywords)
    one.reset(seed=0), other.reset(seed=9)
    for _ in range(6):
        one.step(np.full((2, 1), 0.05, np.float32))
    other.episodes.load_arrays({name: array.copy() for name, array in one.episodes.arrays().items()})
    for _ in range(12):
        for envs in (one, other):
            envs.episodes.core.step(np.full(2, 0.1))
    assert np.array_equal(one.episodes.observe(), other.episodes.observe())


def test_a_lidar_that_scans_rarely_still_shows_a_way() -> None:
    env = made(WALL, lidar={"rate": 0.4})
    infos, _ = follow(env, 200)
    assert len(infos) > 40 and all(np.isfinite(info["lookahead_point"]).all() for info in infos)


def test_the_picture_shows_the_way_that_was_given_and_no_plan_that_nobody_had() -> None:
    from lidarena.world.canvas import BLUE, ORANGE

    pictures = {}
    for observation in ("way", "proximity"):
        env = ArenaEnv(arena=WALL, observation=observation, knowledge="lidar", render_mode="rgb_array")
        env.reset(seed=0)
        env.step(np.zeros(1, np.float32))
        picture = env.render()
        assert picture is not None
        panel = picture[44:-64]
        pictures[observation] = [int((panel == colour).all(axis=2).sum()) for colour in (BLUE, ORANGE)]
    assert pictures["way"][0] > 300 and pictures["way"][1] == 0
    assert pictures["proximity"] == [0, 0]


def test_the_shipped_agent_is_shown_a_way() -> None:
    env = gym.make("lidarena/Arena-v0", observation="way", action="discrete", guard=True, knowledge="lidar")
    policy = lidarena.agents.load("pretrained:arena", env)
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    done = False
    while not done:
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        done = terminated or truncated
    assert info["success"]
