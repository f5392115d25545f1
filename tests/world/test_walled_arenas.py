import numpy as np
import pytest

from lidarena.planning.potential_field.circle_grid import astar_path
from lidarena.world import walled_arenas

TRAINED = ("walls", "pockets", "mazes", "rooms")
ASKED = ("long_wall", "zigzag", "u_wall", "cul_de_sac")


@pytest.mark.parametrize("name", TRAINED + ASKED)
def test_ends_are_free_and_far_apart_and_the_same_number_draws_the_same_arena(name: str) -> None:
    for seed in range(12):
        arena, again = (getattr(walled_arenas, name)(np.random.default_rng(seed)) for _ in range(2))
        assert np.array_equal(arena.circles, again.circles) and arena.start == again.start and arena.goal == again.goal
        for end in (arena.start, arena.goal):
            away = np.hypot(*(arena.circles[:, :2] - end).T) - arena.circles[:, 2]
            assert away.min(initial=99.0) > arena.robot_radius
        assert np.hypot(*np.subtract(arena.goal, arena.start)) >= 60.0
        assert arena.name == name and arena.scale == 1.0


@pytest.mark.parametrize("name", ("mazes", "rooms", *ASKED))
def test_there_is_a_way(name: str) -> None:
    for seed in range(6):
        arena = getattr(walled_arenas, name)(np.random.default_rng(seed))
        path = astar_path(arena.circles, arena.start, arena.goal, arena.robot_radius, arena.bounds)
        assert len(path) > 1


@pytest.mark.parametrize("name", ("long_wall", "zigzag", "u_wall", "cul_de_sac"))
def test_what_is_asked_about_stands_in_the_straight_way(name: str) -> None:
    blocked = 0
    for seed in range(20):
        arena = getattr(walled_arenas, name)(np.random.default_rng(seed))
        way = np.linspace(arena.start, arena.goal, 400)
        away = np.hypot(*(way[:, None] - arena.circles[None, :, :2]).transpose(2, 0, 1)) - arena.circles[:, 2]
        blocked += bool(away.min() < arena.robot_radius)
    assert blocked >= 15


def test_posts_of_a_wall_touch() -> None:
    posts = walled_arenas.posts_along([(0.0, 0.0), (10.0, 0.0), (10.0, 7.0)])
    apart = np.hypot(*np.diff(posts[:, :2], axis=0).T)
    assert apart.max() < 2 * posts[0, 2] and np.hypot(*(posts[-1, :2] - (10.0, 7.0))) == 0.0
