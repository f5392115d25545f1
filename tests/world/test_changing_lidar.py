"""A lidar whose worlds exchange their plans sees what one sees that was made for these plans."""

import numpy as np

from lidarena.world.changing_lidar import ChangingLidar
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec
from lidarena.world.load import load_floorplan
from tests.world.test_plan_generators import growing

SPEC = LidarSpec(beams=90, max_range=3.5)


def expected(plan: Floorplan, pose: np.ndarray) -> np.ndarray:
    return Lidar([plan], SPEC).cast(pose[None], np.zeros(1, np.int64))[0]


def test_every_world_sees_its_own_plan_whatever_the_others_change_to() -> None:
    rng, worlds = np.random.default_rng(0), 4
    lidar = ChangingLidar(worlds, SPEC)
    plans: list[Floorplan | None] = [None] * worlds
    names = ["env1", "maze:3", "env4", "turtlebot3_world", "maze:9?width=12"]
    for k in range(24):
        world = int(rng.integers(worlds))
        plan = load_floorplan(names[k % 5]) if k % 3 else growing(np.random.default_rng(k))
        plans[world] = plan
        lidar.exchange(world, plan)
        poses = np.zeros((worlds, 1, 3))
        for w, own in enumerate(plans):
            if own is not None:
                poses[w, 0] = own.start[0], own.start[1], rng.uniform(-3, 3)
        ranges = lidar.cast(poses, np.arange(worlds))
        for w, own in enumerate(plans):
            if own is not None:
                assert ranges[w].tobytes() == expected(own, poses[w]).tobytes()


def test_room_is_made_seldom() -> None:
    lidar = ChangingLidar(2, SPEC)
    lidar.exchange(0, load_floorplan("maze:1"))
    first = lidar.geometry
    for seed in range(2, 12):
        lidar.exchange(seed % 2, load_floorplan(f"maze:{seed}"))
    assert lidar.geometry is first


def test_a_smaller_plan_leaves_nothing_of_the_larger_one() -> None:
    lidar = ChangingLidar(1, SPEC)
    lidar.exchange(0, load_floorplan("env3"))
    plan = growing(np.random.default_rng(3))
    lidar.exchange(0, plan)
    pose = np.array([[1.0, 1.0, 0.3]])
    assert lidar.cast(pose[None], np.zeros(1, np.int64))[0].tobytes() == expected(plan, pose).tobytes()
