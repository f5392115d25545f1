"""Obstacles that move: what they may be, where they go, and that the robot sees and meets them."""

import math

import gymnasium as gym
import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.envs.arena.moving import KINDS, MovingSpec
from lidarena.envs.arena.options import ArenaOptions
from lidarena.envs.arena.state import ArenaCore
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import LidarSpec


def core(worlds: int = 1, **keywords: object) -> ArenaCore:
    made = ArenaCore(worlds, ArenaOptions.checked(keywords))
    for world in range(worlds):
        made.reset_world(world, np.random.default_rng(world), None)
    return made


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_drives_into_what_stands_or_out_of_the_room(kind: str) -> None:
    arenas = core(2, arena="random", density=0.1, moving={"number": 8, "speed": (0.5, 2.0), "kind": kind})
    radius, seen = float(arenas.moving.radius[0]), []
    for _ in range(60):
        arenas.step(np.zeros(2))
        for world in range(2):
            scenario = arenas.scenarios[world]
            assert scenario is not None
            away = scenario.plan.clearance(arenas.moving.states[world, :, :2])
            assert away.min() >= radius - 1e-6
        seen.append(arenas.moving.states[:, :, :2].copy())
    driven = np.hypot(*np.diff(np.array(seen), axis=0).transpose(3, 0, 1, 2))
    assert driven.max() <= 2.0 * arenas.period + 1e-9
    assert (driven.sum(axis=0) > 10.0 * arenas.period).mean() > 0.8  # most of them are on their way


def test_what_crosses_goes_to_and_fro_across_the_way_to_the_goal() -> None:
    arenas = core(arena="random", density=0.0, moving={"number": 5, "kind": "crossing"})
    way = arenas.goals[0] - arenas.physics.poses[0, 0, :2]
    for _ in range(80):
        arenas.step(np.zeros(1))
        velocities = arenas.moving.states[0, :, 2:]
        assert np.abs(velocities @ way).max() < 1e-6 * np.hypot(*way)


def test_people_make_room_for_the_robot() -> None:
    arenas = core(arena="random", density=0.0, moving={"number": 1, "speed": 1.0, "kind": "people"})
    x, y = arenas.physics.poses[0, 0, :2]
    reach = float(arenas.moving.radius[0] + arenas.radii[0])
    arenas.moving.states[0, 0] = x + 1.5 * reach, y + 0.1 * reach, 0.0, 0.0
    arenas.moving.targets[0, 0] = x - 10.0 * reach, y
    arenas.step(np.array([math.pi / 2 - arenas.physics.poses[0, 0, 2]]))
    vx, vy = arenas.moving.states[0, 0, 2:]
    assert vx > -0.9  # it does not run into the robot at full speed
    assert math.hypot(vx, vy) <= 1.0 + 1e-9


def test_the_lidar_sees_them_where_they_are() -> None:
    arenas = core(arena="random", density=0.0, moving=1)
    x, y, theta = arenas.physics.poses[0, 0]
    radius = float(arenas.moving.radius[0])
    ahead = np.array([math.cos(theta), math.sin(theta)])
    arenas.moving.states[0, 0, :2] = (x, y) + 9.0 * ahead
    arenas._sense(arenas.physics.poses, 0, 1)
    assert arenas.measurements.scans[0, 0, 0] == pytest.approx(9.0 - radius)
    arenas.moving.states[0, 0, :2] = (x, y) - 9.0 * ahead
    arenas._sense(arenas.physics.poses, 0, 1)
    assert arenas.measurements.scans[0, 0, 18] == pytest.approx(9.0 - radius)


@pytest.mark.parametrize("aside", [0.0, 0.5, 1.5])
def test_who_meets_the_robot_ends_the_episode_and_who_passes_does_not(aside: float) -> None:
    env = gym.make("lidarena/Arena-v0", arena="random", density=0.0, moving={"number": 1, "speed": 1.0}).unwrapped
    env.reset(seed=3)
    arenas = env.episodes.core
    x, y, theta = arenas.physics.poses[0, 0]
    reach = float(arenas.moving.radius[0] + arenas.radii[0])
    ahead, left = np.array([math.cos(theta), math.sin(theta)]), np.array([-math.sin(theta), math.cos(theta)])
    arenas.moving.states[0, 0, :2] = (x, y) + (reach + 1.0) * ahead + aside * reach * left
    arenas.moving.states[0, 0, 2:] = -ahead
    met = False
    for _ in range(12):
        _, _, terminated, _, info = env.step(np.zeros(1, np.float32))
        arenas.moving.states[0, 0, 2:] = -ahead
        met = met or info["collision"]
        assert terminated == info["collision"] or info["success"]
        assert info["clearance"] >= 0.0
        if met:
            break
    assert met == (aside < 1.0)


def test_obstacles_pass_through_each_other_without_a_collision_of_the_robot() -> None:
    arenas = core(arena="random", density=0.0, moving=2)
    x, y, theta = arenas.physics.poses[0, 0]
    reach = float(arenas.moving.radius[0] + arenas.radii[0])
    side = np.array([-math.sin(theta), math.cos(theta)])
    arenas.moving.states[0, :, :2] = (x, y) + 1.0005 * reach * side  # beside the robot, on top of each other
    arenas.moving.states[0, :, 2:] = 0.0
    arenas.moving.speeds[:] = 0.0
    arenas.step(np.zeros(1))
    assert not arenas.physics.touched.any()


def test_what_is_saved_goes_on_to_the_bit_and_a_seed_repeats_an_episode() -> None:
    keywords = {"arena": "random", "moving": {"number": 6, "kind": "mixed", "speed": (0.2, 1.5)}}
    one, other, same = (core(2, **keywords) for _ in range(3))
    for arenas in (one, same):
        for _ in range(5):
            arenas.step(np.array([0.2, -0.1]))
    assert np.array_equal(one.moving.states, same.moving.states)
    other.load_arrays({name: array.copy() for name, array in one.arrays().items()})
    for arenas in (one, other):
        for _ in range(15):
            arenas.step(np.array([0.1, 0.3]))
    assert np.array_equal(one.moving.states, other.moving.states)
    assert np.array_equal(one.measurements.scans, other.measurements.scans)


def test_the_info_tells_them_where_obstacles_are_known() -> None:
    for knowledge in ("map", "lidar"):
        env = gym.make("lidarena/Arena-v0", moving=3, knowledge=knowledge, expose_truth=True).unwrapped
        _, info = env.reset(seed=0)
        assert info["truth"]["moving"].shape == (3, 5)
        assert ("moving" in info) == (knowledge == "map")
    _, info = gym.make("lidarena/Arena-v0").unwrapped.reset(seed=0)
    assert "moving" not in info


def test_every_episode_draws_how_many_there_are() -> None:
    arenas = core(2, arena="random", density=0.1, moving={"number": [0, 5], "kind": "mixed"})
    counts = set()
    for seed in range(30):
        for world in range(2):
            arenas.reset_world(world, np.random.default_rng(seed), None)
        counts.add(int(arenas.moving.counts[0]))
        assert arenas.moving.discs(0).shape == (arenas.moving.counts[0], 5)
        before = arenas.moving.states.copy()
        arenas.step(np.zeros(2))
        beyond = np.arange(5) >= arenas.moving.counts[0]
        assert np.array_equal(arenas.moving.states[0, beyond], before[0, beyond])  # they are not there
    assert counts == set(range(6))


def test_worlds_with_different_numbers_tell_each_its_own() -> None:
    envs = gym.make_vec(
        "lidarena/Arena-v0", 6, vectorization_mode="vector_entry_point", moving={"number": [0, 4]}, knowledge="map"
    )
    _, infos = envs.reset(seed=0)
    shapes = {moving.shape for moving in infos["moving"]}
    assert len(shapes) > 1 and all(columns == 5 for _, columns in shapes)
    _, info = gym.make("lidarena/Arena-v0", moving={"number": [3, 3]}).unwrapped.reset(seed=0)
    assert info["moving"].shape == (3, 5)


def test_they_move_among_the_walls_of_a_floor_plan() -> None:
    walls = [(0, 0, 0, 8), (0, 8, 8, 8), (8, 8, 8, 0), (8, 0, 0, 0)]
    plan = Floorplan("hall", np.array(walls, float), np.array([[4.0, 4.0, 1.0]]), (0.0, 0.0, 8.0, 8.0), (1.0, 1.0, 0.0))
    arenas = core(arena=plan, goal=(7.0, 7.0), moving={"number": 4, "radius": 0.3, "kind": "waypoints"})
    for _ in range(100):
        arenas.step(np.full(1, 1.0))
        assert plan.clearance(arenas.moving.states[0, :, :2]).min() >= 0.3 - 1e-6


@pytest.mark.parametrize(
    ("moving", "words"),
    [
        ({"number": -1}, "moving.number = -1"),
        (-3, "moving.number = -3"),
        ({"number": 2.5}, "moving.number"),
        ({"number": [1, 2, 3]}, "least and the greatest"),
        ({"number": (5, 2)}, "in this order"),
        ({"number": "many"}, "moving.number"),
        ({"number": (0, 1000)}, "moving.number = 1000"),
        ({"number": 3, "speed": -1.0}, "moving.speed"),
        ({"number": 3, "speed": (2.0, 1.0)}, "in this order"),
        ({"number": 3, "speed": "fast"}, "moving.speed"),
        ({"number": 3, "kind": "peple"}, "people"),
        ({"numbr": 3}, "number"),
        ("many", "moving = 'many'"),
        ({"number": 3, "radius": 0.0}, "moving.radius"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(moving: object, words: str) -> None:
    with pytest.raises(ConfigError, match=words.replace("(", r"\(")):
        ArenaOptions.checked({"moving": moving})


def test_a_speed_that_the_lidar_cannot_see_coming_is_refused() -> None:
    spec = MovingSpec(number=1, speed=20.0)
    spec.check_seen(LidarSpec(max_range=30.0), 1.0, 1.0)
    with pytest.raises(ConfigError, match=r"more than this lidar can see coming.*at most 14 m/s"):
        spec.check_seen(LidarSpec(max_range=30.0, rate=0.5), 1.0, 1.0)
    with pytest.raises(ConfigError, match="see coming"):
        gym.make("lidarena/Arena-v0", moving={"number": 1, "speed": 50.0})
