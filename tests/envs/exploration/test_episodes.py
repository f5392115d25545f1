import numpy as np
import pytest

from lidarena.base.errors import ActionError
from lidarena.envs.exploration.episodes import ExplorationEpisodes
from lidarena.envs.exploration.options import ExplorationOptions


def begun(worlds: int = 2, **keywords: object) -> ExplorationEpisodes:
    made = ExplorationEpisodes(worlds, ExplorationOptions.checked({"map": "env1", "slam": "truth", **keywords}))
    made.reset(range(worlds), [np.random.default_rng(k) for k in range(worlds)])
    return made


@pytest.mark.parametrize("observation", ["da_slam", "sectors", "frontier_histogram", "frontier_arcs", "map"])
def test_observations_lie_in_their_space(observation: str) -> None:
    made = begun(observation=observation)
    for _ in range(3):
        seen = made.observe()
        for k in range(2):
            row = {name: part[k] for name, part in seen.items()} if isinstance(seen, dict) else seen[k]
            assert made.single_observation_space.contains(row)
        made.step(np.zeros(2, np.int64))


def test_an_episode_is_cut_off_after_its_steps_and_not_before() -> None:
    made = begun(max_episode_steps=3)
    ends = [made.step(np.array([1, 2]))[2].tolist() for _ in range(3)]
    assert ends == [[False, False], [False, False], [True, True]]


def test_a_map_that_is_complete_enough_ends_an_episode_with_success() -> None:
    made = begun(1, stop_at=0.05)
    _, terminated, _ = made.step(np.array([0]))
    assert terminated.tolist() == [True] and made.infos()["success"].tolist() == [True]


def test_patience_ends_what_gets_no_further() -> None:
    made, steps = begun(1, patience=1.0, stop_at=None), 0
    truncated = np.array([False])
    while not truncated[0] and steps < 60:
        _, _, truncated = made.step(np.array([1]))
        steps += 1
    assert 5 <= steps < 60


def test_only_the_worlds_that_are_reset_begin_anew() -> None:
    made = begun()
    for _ in range(4):
        made.step(np.zeros(2, np.int64))
    before = made.infos()["completeness"].copy()
    made.reset([1], [np.random.default_rng(7), np.random.default_rng(8)])
    after = made.infos()["completeness"]
    assert after[0] == before[0] and after[1] < before[1]


def test_a_refused_action_moves_nothing() -> None:
    made = begun()
    before = made.core.physics.poses.copy()
    with pytest.raises(ActionError):
        made.step(np.array([0, 3]))
    assert np.array_equal(made.core.physics.poses, before)
