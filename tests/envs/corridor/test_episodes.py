"""Episodes of teams: what a step earns, who is finished and stays, how the team has done, and what is saved."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.envs import corridor_v0
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.rewards import REWARDS
from tests.envs.corridor.corridor_worlds import EXACT, begin

AHEAD = {"robots": 3, "starts": [(2.0, 7.5), (6.0, 7.5), (12.0, 7.5)], "goals": [(3.0, 7.5), (17.0, 7.5), (9.0, 7.5)]}
"""Robot 0 is soon there; robots 1 and 2 meet on the way, if they drive ahead."""
WEIGHTS = {"progress": 1.5, "arrival": 7.0, "collision": 4.0, "time": 0.3, "closeness": 2.0, "turning": 0.25}


def step(episodes: CorridorEpisodes, speed: float = 1.0, turn: float = 0.0) -> tuple[NDArray[Any], ...]:
    return episodes.step(np.full((*episodes.finished.shape, 2), (speed, turn)))


def test_the_terms_add_up_to_the_reward_and_are_what_they_say() -> None:
    episodes = begin(2, robots=6, map="unstructured", places="random", robot={"radius": 0.2}, reward=WEIGHTS)
    core, rng = episodes.core, np.random.default_rng(3)
    earned = dict.fromkeys(REWARDS.names, 0.0)
    for _ in range(60):
        before, active, headings = (
            core.measurements.remaining.copy(),
            ~episodes.finished,
            core.physics.poses[..., 2].copy(),
        )
        rewards, _, _ = episodes.step(rng.uniform((0.2, -0.6), 1.0, (2, 6, 2)))
        terms = episodes.robot_infos()["reward_terms"]
        assert tuple(terms) == REWARDS.names
        assert np.allclose(sum(terms.values()), rewards, atol=1e-12)
        turned = np.abs(np.angle(np.exp(1j * (core.physics.poses[..., 2] - headings))))
        touched = core.physics.touched_wall | core.physics.touched_robot
        nearest = np.clip(1.0 - (core.measurements.ranges.min(axis=2) - 0.2) / 0.4, 0.0, 1.0)
        expected = {
            "progress": 1.5 * (before - core.measurements.remaining),
            "arrival": 7.0 * (episodes.finished & ~touched),
            "collision": -4.0 * touched,
            "time": np.full((2, 6), -0.3 * 0.2),
            "closeness": -2.0 * 0.2 * nearest,
            "turning": -0.25 * turned,
        }
        for name, term in terms.items():
            assert np.allclose(term, np.where(active, expected[name], 0.0), atol=1e-9), name
            earned[name] += float(np.abs(term).sum())
    assert all(earned[name] > 0.0 for name in REWARDS.names if name != "arrival")


def test_progress_over_an_episode_is_the_way_that_was_made() -> None:
    episodes = begin(robots=1, starts=[(2.0, 7.5)], goals=[(3.7, 7.5)], **EXACT)
    before, made = float(episodes.core.measurements.remaining[0, 0]), 0.0
    while not episodes.arrived.all():
        step(episodes)
        made += float(episodes.robot_infos()["reward_terms"]["progress"][0, 0])
    assert made == pytest.approx(before - episodes.core.measurements.remaining[0, 0])
    assert episodes.core.measurements.remaining[0, 0] <= 0.15 and episodes.steps[0] == 16


def test_a_robot_that_has_arrived_stays_earns_nothing_and_touches_nothing() -> None:
    episodes = begin(**AHEAD, **EXACT)
    while not episodes.arrived[0, 0]:
        rewards, terminated, _ = step(episodes)
    assert terminated.tolist() == [[True, False, False]] and rewards[0, 0] > 9.0
    pose = episodes.core.physics.poses[0, 0].copy()
    for _ in range(5):
        rewards, terminated, _ = step(episodes)
        assert rewards[0, 0] == 0.0 and not terminated[0, 0]
        assert not any(term[0, 0] for term in episodes.robot_infos()["reward_terms"].values())
    assert np.array_equal(episodes.core.physics.poses[0, 0], pose)
    assert not episodes.observe()[0, 0].any() and episodes.observe(hide_finished=False)[0, 0].any()


def test_who_runs_into_one_that_has_arrived_collides_and_the_other_does_not() -> None:
    places = {"starts": [(2.0, 7.5), (1.0, 7.5)], "goals": [(2.6, 7.5), (9.0, 7.5)]}
    episodes = begin(robots=2, **places, **EXACT)
    for _ in range(20):
        step(episodes)
    assert episodes.arrived.tolist() == [[True, False]] and episodes.finished.all()
    assert (episodes.touches > 0).tolist() == [[False, True]]
    assert episodes.robot_infos()["collision"].tolist() == [[False, True]]


@pytest.mark.parametrize("ends", [True, False])
def test_who_touches_something_at_the_goal_has_arrived_only_where_touches_do_not_count(ends: bool) -> None:
    places = {"starts": [(5.0, 7.5), (5.6, 7.5)], "goals": [(5.4, 7.5), (1.0, 7.5)]}
    episodes = begin(robots=2, collision_ends=ends, goal_tolerance=0.02, **places, **EXACT)
    for _ in range(4):  # robot 0 drives into robot 1, which stands, until its centre is at the goal
        episodes.step(np.array([[(1.0, 0.0), (0.0, 0.0)]]))
    assert episodes.touches[0, 0] == 1 and episodes.arrived[0, 0] == (not ends)


def test_measures_are_those_of_what_happened() -> None:
    episodes = begin(**AHEAD, **EXACT)
    met = np.nan
    for count in range(1, 41):
        step(episodes)
        met = 0.2 * count if np.isnan(met) and episodes.finished[0, 1] else met
    found = {name: float(value[0]) for name, value in episodes.measures().items()}
    there = 0.2 * 9  # 0.1 m a step; near enough after 0.9 m
    assert found == pytest.approx({
        "arrival": 1 / 3, "all_arrived": 0.0, "collided": 2 / 3, "makespan": 8.0, "mean_time": (there + 8.0 + 8.0) / 3,
    })  # fmt: skip
    assert 5.5 < met < 6.1 and episodes.over.all()  # 6 m less two radii at 1 m/s
    assert episodes.robot_infos()["path_length"][0, 0] == pytest.approx(0.9)


def test_time_cuts_off_who_is_on_the_way_and_ends_nobody_twice() -> None:
    episodes = begin(max_episode_steps=12, **AHEAD, **EXACT)
    ends = []
    for _ in range(12):
        _, terminated, truncated = step(episodes)
        ends.append((terminated[0].tolist(), truncated[0].tolist()))
    nobody = [False, False, False]
    assert [terminated for terminated, _ in ends].count([True, False, False]) == 1
    assert all(truncated == nobody for _, truncated in ends[:-1])
    assert ends[-1] == (nobody, [False, True, True]) and episodes.over.all()
    assert episodes.time.tolist() == pytest.approx([12 * 0.2])


def test_who_arrives_in_the_last_step_is_not_cut_off() -> None:
    episodes = begin(max_episode_steps=9, **AHEAD, **EXACT)
    for _ in range(9):
        _, terminated, truncated = step(episodes)
    assert terminated.tolist() == [[True, False, False]] and truncated.tolist() == [[False, True, True]]


def test_a_new_episode_remembers_nothing_of_the_old_one() -> None:
    episodes, fresh = begin(**AHEAD, stall_rate=0.2), begin(**AHEAD, stall_rate=0.2)
    while not episodes.finished.all():
        step(episodes)
    assert episodes.touches.any() and episodes.arrived.any()
    for one in (episodes, fresh):
        one.reset([0], [np.random.default_rng(8)])
    own = {name: array for name, array in episodes.arrays().items() if not name.startswith("touched_")}
    for name, array in own.items():  # the touches of the last step are forgotten with the next
        assert np.array_equal(array, fresh.arrays()[name], equal_nan=array.dtype.kind == "f"), name
    for _ in range(10):
        assert np.array_equal(step(episodes)[0], step(fresh)[0])


def test_an_observation_has_no_number_beyond_one() -> None:
    episodes = begin(3, robots=6, map="unstructured", neighbours=3, motion_noise=10.0, lidar={"noise": 1.0})
    for _ in range(15):
        step(episodes, 1.0, 0.4)
        seen = episodes.observe(hide_finished=False)
        assert np.isfinite(seen).all() and np.abs(seen).max() <= 1.0
        assert np.allclose(np.hypot(seen[..., 36], seen[..., 37]), 1.0, atol=1e-5)  # the goal's bearing
        assert np.allclose(np.hypot(seen[..., 41], seen[..., 42]), 1.0, atol=1e-5)  # the way's


def test_the_infos_of_one_step_do_not_change_with_the_next() -> None:
    episodes = begin(**AHEAD, expose_truth=True)
    step(episodes)
    infos = episodes.robot_infos() | episodes.world_infos()
    kept = {name: np.array(value) for name, value in infos.items() if not isinstance(value, dict)}
    truth = infos["truth"]["pose"].copy()
    step(episodes)
    assert all(np.array_equal(infos[name], value) for name, value in kept.items())
    assert np.array_equal(infos["truth"]["pose"], truth) and not np.array_equal(episodes.core.physics.poses, truth)


def test_a_state_saved_after_an_arrival_continues_elsewhere_with_the_same_robots_and_can_be_drawn() -> None:
    keywords: dict[str, Any] = {**AHEAD, "stall_rate": 0.2, "render_mode": "rgb_array"}
    env, other = corridor_v0.parallel_env(**keywords), corridor_v0.parallel_env(**keywords)
    env.reset(seed=5)
    other.reset(seed=6)
    go = np.array([0.9, 0.0], np.float32)
    while len(env.agents) == 3:
        env.step(dict.fromkeys(env.agents, go))
    untouched = corridor_v0.parallel_env(**keywords)
    state = env.get_state()
    for _ in range(3):
        env.step(dict.fromkeys(env.agents, go))
    for again in (other, untouched):
        again.set_state(state)
        assert again.agents == ["robot_1", "robot_2"]
        assert again.render() is not None
        for _ in range(3):
            again.step(dict.fromkeys(again.agents, go))
        assert np.array_equal(again.state(), env.state())
        assert again.episodes.measures() == env.episodes.measures()
        picture = again.render()
        assert picture is not None and picture.shape == env.render().shape
