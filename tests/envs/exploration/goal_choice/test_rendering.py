import gymnasium as gym
import numpy as np

import lidarena  # noqa: F401
from lidarena.envs.exploration.goal_choice.rendering import TEAL

MAZE = "maze:5?width=5&height=5"


def teal_cells(picture: np.ndarray) -> tuple[int, int]:
    """How much of each half is of the colour of the way."""
    there = (picture == TEAL).all(axis=2)
    half = picture.shape[1] // 2
    return int(there[:400, :half].sum()), int(there[:400, half:].sum())


def test_the_way_and_the_frontiers_are_drawn_where_the_belief_is() -> None:
    env = gym.make("lidarena/GoalChoice-v0", map=MAZE, slam="truth", render_mode="rgb_array")
    env.reset(seed=0)
    before = teal_cells(env.render())
    for _ in range(3):
        env.step(0)
    after = teal_cells(env.render())
    assert before[0] == after[0] == 0
    assert after[1] > before[1] > 0, "the way joins the frontiers"


def test_worlds_of_a_batch_are_drawn_one_by_one() -> None:
    envs = gym.make_vec("lidarena/GoalChoice-v0", 2, "vector_entry_point", map=MAZE, slam="truth", start="random",
                        render_mode="rgb_array")  # fmt: skip
    envs.reset(seed=0)
    one, other = envs.render()
    assert one.shape == other.shape and not np.array_equal(one, other)
