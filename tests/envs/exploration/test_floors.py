"""A generator's plans in exploration: a new one every episode, the same for a seed in any batch, saved and restored."""

from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded

import lidarena
from lidarena.base.errors import MapError
from lidarena.envs import BatchedExploration, ExplorationEnv
from lidarena.envs.exploration.coverage import measure_coverage
from lidarena.envs.infos import row_of
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan
from tests.envs.batch_runs import raw, world_of
from tests.world.test_plan_generators import HERE, Rooms, growing, room

STEPS = 40
CASES: dict[str, dict[str, Any]] = {
    "one size": {"map": room, "reward": "combined"},
    "named": {"map": f"{HERE}:Rooms", "slam": "truth", "start": "random"},
    "random plans": {"map": "random:mixed?area_min=20&area_max=40", "slam": "truth", "start": "random"},
    "with others": {"map": [Rooms(), "env1", f"{HERE}:room"], "observation": "map"},
}
every_case = pytest.mark.parametrize("case", CASES)


def shape_of(env: Any) -> bytes:
    return raw(env.unwrapped.floorplan.edges) + raw(env.unwrapped.floorplan.circles)


def alone(seed: int, keywords: dict[str, Any]) -> tuple[list[bytes], set[bytes]]:
    env: Any = gym.make("lidarena/Exploration-v0", max_episode_steps=15, **keywords)
    observation, info = env.reset(seed=seed)
    record, plans = [raw(observation) + raw(info)], {shape_of(env)}
    for action in np.random.default_rng(seed).integers(0, 3, STEPS):
        observation, reward, terminated, truncated, info = env.step(action)
        if terminated or truncated:
            observation, info = env.reset()
            plans.add(shape_of(env))
        record.append(raw(observation) + raw(info) + raw([reward, terminated, truncated]))
    return record, plans


@every_case
def test_a_seed_gives_the_same_plans_and_bits_in_any_batch(case: str) -> None:
    keywords = CASES[case]
    for count in (1, 4):
        batch = gym.make_vec("lidarena/Exploration-v0", count, "vector_entry_point", max_episode_steps=15, **keywords)
        observations, infos = batch.reset(seed=2)
        told = [[raw_row(observations, k) + raw(world_of(infos, k))] for k in range(count)]
        table = np.stack([np.random.default_rng(2 + k).integers(0, 3, STEPS) for k in range(count)], axis=1)
        for actions in table:
            observations, rewards, terminated, truncated, infos = batch.step(actions)
            for k in range(count):
                end = raw([rewards[k], terminated[k], truncated[k]])
                told[k].append(raw_row(observations, k) + raw(world_of(infos, k)) + end)
        drawn = set()
        for k in range(count):
            expected, plans = alone(2 + k, keywords)
            assert told[k] == expected
            drawn |= plans
        assert len(drawn) > count


def raw_row(observations: Any, k: int) -> bytes:
    return raw(row_of(observations, k))


@every_case
def test_a_saved_batch_goes_on_to_the_bit_in_its_plans(case: str) -> None:
    one, two = (BatchedExploration(4, max_episode_steps=12, **CASES[case]) for _ in range(2))
    one.reset(seed=0)
    two.reset(seed=9)
    table = np.random.default_rng(0).integers(0, 3, (40, 4))
    for actions in table[:17]:
        one.step(actions)
    saved = one.get_state()
    assert all(array.dtype != object for array in saved.values())
    fresh = BatchedExploration(4, max_episode_steps=12, **CASES[case])
    for batch in (two, fresh):
        batch.set_state(saved)
    for actions in table[17:]:
        first = one.step(actions)
        for batch in (two, fresh):
            again = batch.step(actions)
            assert [raw(part) for part in first[:4]] == [raw(part) for part in again[:4]]


def test_coverage_physics_and_pictures_follow_the_plan() -> None:
    env = ExplorationEnv(map=Rooms, slam="truth", render_mode="rgb_array")
    sizes = set()
    for seed in range(4):
        env.reset(seed=seed)
        plan, core = env.floorplan, env.episodes.core
        sizes.add(plan.bounds)
        assert core.floors.wanted_cells[0] == measure_coverage(plan, 0.05, core.robot).wanted.sum()
        assert core.maps.wanted is core.floors.wanted
        terminated = truncated = False
        while not (terminated or truncated):
            *_, terminated, truncated, info = env.step(0)
        assert info["collision"] and plan.clearance(core.physics.poses[:, 0, :2])[0] < 0.2
        assert env.render() is not None
    assert len(sizes) == 4


def test_a_whole_plan_can_be_mapped() -> None:
    env = ExplorationEnv(map=room, slam="truth")
    policy = lidarena.baselines.make("frontier", env)
    observation, info = env.reset(seed=1)
    policy.reset(seed=1)
    for _ in range(600):
        observation, _, terminated, _, info = env.step(policy.act(observation, info))
        if terminated:
            break
    assert info["completeness"] > 0.99 and not info["collision"]


def test_maps_have_one_shape_for_all_episodes() -> None:
    env = ExplorationEnv(map=Rooms, slam="truth")
    shapes = {env.reset(seed=seed)[1]["map"].shape for seed in range(5)}
    assert len(shapes) == 1 and shapes.pop() >= (150, 140)


def crowded(rng: np.random.Generator) -> Floorplan:
    plan = room(rng)
    return Floorplan("crowded", plan.edges, np.array([[2.0, 2.0, 1.9]]), plan.bounds, (2.0, 2.0, 0.0))


def test_no_room_for_the_robot_is_refused() -> None:
    with pytest.raises(MapError, match=r"does not fit at the start .* of map 'crowded'"):
        ExplorationEnv(map=crowded).reset(seed=0)
    with pytest.raises(MapError, match=r"does not fit at the start .* of map 'crowded'"):
        ExplorationEnv(map=crowded(np.random.default_rng(0)))


def test_a_plan_larger_than_was_said_is_refused() -> None:
    small = partial(growing)
    small.size = (3.0, 3.0)  # type: ignore[attr-defined]
    with pytest.raises(MapError, match=r"drew a plan of .* the largest that it says is 3 × 3 m"):
        ExplorationEnv(map=small).reset(seed=0)


def test_before_the_first_episode_there_is_no_plan() -> None:
    with pytest.raises(ResetNeeded, match="no floor plan before reset"):
        _ = ExplorationEnv(map=room).floorplan
    assert ExplorationEnv(map="env1").floorplan.name == "env1"


def test_the_start_can_be_given() -> None:
    env = ExplorationEnv(map=room, start=(0.6, 0.7, 1.0))
    env.reset(seed=0)
    assert env.episodes.core.physics.poses[0, 0].tolist() == [0.6, 0.7, 1.0]
    with pytest.raises(MapError, match="stands in a wall"):
        ExplorationEnv(map=room, start=(0.01, 0.7, 1.0)).reset(seed=0)


def test_fixed_plans_are_shared() -> None:
    batch = BatchedExploration(3, map=["env1", "env2"])
    batch.reset(seed=0)
    floors = batch.episodes.core.floors
    assert floors.plans == [load_floorplan("env1"), load_floorplan("env2")] and len(floors.wanted) == 2


def test_random_starts_in_drawn_plans_are_roomy() -> None:
    batch: Any = gym.make_vec(
        "lidarena/Exploration-v0", 6, "vector_entry_point", map="random:mixed", start="random", slam="truth"
    )
    for seed in (0, 6):
        batch.reset(seed=seed)
        core = batch.unwrapped.episodes.core
        for world in range(6):
            assert core.plans[world].clearance(core.physics.poses[world, :, :2])[0] >= 0.3


@pytest.mark.parametrize(
    ("spec", "sentence"),
    [
        ("random:furnishd", "no kind of random plans 'furnishd'; did you mean 'furnished'"),
        ("random:rooms?dor=1", "no option 'dor'; did you mean 'door'"),
        ("random:rooms?door=one", "door 'one'; a number is needed"),
        ("random:maze?area=10", "area 10; 20 to 400 are allowed"),
        ("random:warehouse?area=20&aisle=3", "no room for a rack"),
        ("random:rooms?area_min=20&room=5", "no room for two rooms of 5 m"),
        ("random", "'random' is not known; did you mean 'random:KIND'"),
    ],
)
def test_random_plans_that_cannot_be_are_refused_when_worlds_are_made(spec: str, sentence: str) -> None:
    with pytest.raises(MapError, match=sentence) as refusal:
        gym.make_vec("lidarena/Exploration-v0", 2, "vector_entry_point", map=spec, slam="truth")
    assert "\n" not in str(refusal.value)


def test_what_is_sensed_is_what_stands_in_the_plan_that_was_drawn_last() -> None:
    env = ExplorationEnv(map="random:maze", slam="truth")
    core = env.episodes.core
    for seed in range(6):
        env.reset(seed=seed)
        env.step(0)
        assert core.sensors.ranges.tobytes() == core.lidar.cast(core.physics.poses, core.plan).tobytes()
        assert core.sensors.ranges.min() < core.beam.max_range
