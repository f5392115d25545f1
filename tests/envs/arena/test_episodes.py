import numpy as np
import pytest

from lidarena.base.errors import ActionError
from lidarena.envs.arena.episodes import ArenaEpisodes
from lidarena.envs.arena.options import ArenaOptions


def begun(worlds: int = 2, **keywords: object) -> ArenaEpisodes:
    made = ArenaEpisodes(worlds, ArenaOptions.checked({"arena": "random", **keywords}))
    made.reset(range(worlds), [np.random.default_rng(k) for k in range(worlds)])
    return made


def test_observations_lie_in_their_space() -> None:
    for observation in ("ranges", "proximity", "way"):
        made = begun(observation=observation)
        for _ in range(5):
            assert all(made.single_observation_space.contains(row) for row in made.observe())
            made.step(np.zeros((2, 1)))


def test_an_episode_is_cut_off_after_its_steps_and_not_before() -> None:
    made = begun(max_episode_steps=3, density=0.0)
    ends = [made.step(np.zeros((2, 1)))[2].tolist() for _ in range(3)]
    assert ends == [[False, False], [False, False], [True, True]]


def test_reaching_the_goal_ends_an_episode_with_success() -> None:
    made = begun(1, arena="random", density=0.0, goal_radius=90.0)
    rewards, terminated, truncated = made.step(np.zeros((1, 1)))
    assert terminated.all() and not truncated.any() and rewards[0] > 5.0
    assert made.infos()["success"].tolist() == [True]


def test_only_the_worlds_that_are_reset_begin_anew() -> None:
    made = begun()
    for _ in range(4):
        made.step(np.full((2, 1), 0.1))
    before = made.core.physics.poses.copy()
    made.reset([1], [np.random.default_rng(7), np.random.default_rng(8)])
    assert np.array_equal(made.core.physics.poses[0], before[0])
    assert made.infos()["path_length"].tolist()[1] == 0.0 < made.infos()["path_length"].tolist()[0]


def test_a_refused_action_moves_nothing() -> None:
    made = begun()
    before = made.core.physics.poses.copy()
    with pytest.raises(ActionError):
        made.step(np.array([[0.0], [np.nan]]))
    assert np.array_equal(made.core.physics.poses, before)
