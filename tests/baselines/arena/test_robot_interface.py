import math

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.baselines.arena.robot_interface import HeadingController, KnownWorld, known_world
from lidarena.envs import ArenaEnv, BatchedArena

INFO = {
    "circles": np.array([[5.0, 6.0, 1.0]]),
    "bounds": np.array([0.0, 0.0, 10.0, 20.0]),
    "pose": np.array([1.0, 2.0, 0.5]),
    "goal": np.array([8.0, 9.0]),
    "radius": 0.5,
}


def test_the_planners_scene_comes_out_of_the_info() -> None:
    world = known_world("apf", INFO)
    circles, start, goal = world.scene
    assert circles.tolist() == [[5.0, 6.0, 1.0]] and start.tolist() == [1.0, 2.0] and goal.tolist() == [8.0, 9.0]
    assert isinstance(world, KnownWorld) and world.radius == 0.5


def test_for_a_point_obstacles_grow_and_the_room_shrinks() -> None:
    discs, walls = known_world("apf", INFO).grown()
    assert discs.tolist() == [[5.0, 6.0, 1.5]] and walls.tolist() == [0.5, 0.5, 9.5, 19.5]
    assert INFO["circles"].tolist() == [[5.0, 6.0, 1.0]]  # type: ignore[attr-defined]


def test_an_info_without_obstacles_is_refused() -> None:
    with pytest.raises(ConfigError, match="'astar' plans with the obstacles known; make the environment with"):
        known_world("astar", {key: value for key, value in INFO.items() if key != "circles"})


@pytest.mark.parametrize("heading", [-3.0, 0.0, 1.0, 3.1])
@pytest.mark.parametrize("action", ["continuous", "discrete"])
def test_the_wheel_turns_onto_a_heading(heading: float, action: str) -> None:
    env = ArenaEnv(arena="yang", action=action)
    _, info = env.reset(seed=0)
    _, _, _, _, info = env.step(HeadingController(env).towards(heading, info["pose"]))
    off = math.remainder(info["pose"][2] - heading, 2 * math.pi)
    assert abs(off) < (1e-6 if action == "continuous" else math.pi / 16 + 1e-9)


def test_a_batchs_wheel_is_its_worlds() -> None:
    batch, single = BatchedArena(3, arena="gnron"), ArenaEnv(arena="gnron")
    assert HeadingController(batch).step == HeadingController(single).step == pytest.approx(0.1)
    assert HeadingController(batch).towards(0.3, np.zeros(3)) == HeadingController(single).towards(0.3, np.zeros(3))
