import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env

import lidarena  # noqa: F401
from lidarena.base.errors import ActionError, ConfigError, MapError
from lidarena.envs import ArenaEnv, BatchedArena
from lidarena.world.arenas import Arena, load_arena
from tests.planning.potential_field.test_potential_field import BARN, needs_barn

SPECS: list[dict[str, Any]] = [
    {"arena": "yang"},
    {"arena": "yang:arc"},
    {"arena": "yang:u", "action": "discrete", "lidar": {"noise": 0.05}},
    {"arena": "gnron", "knowledge": "lidar"},
    {"arena": "u_trap:3", "render_mode": "rgb_array"},
    {"arena": "u_trap"},
    {"arena": "random:5", "density": 0.22, "lidar": {"beams": 12}},
    {"arena": "random", "density": [0.0, 0.2], "expose_truth": True},
    {"arena": "env2", "goal": (1.0, 6.5)},
    {"arena": "maze:3", "goal": (1.0, 1.0), "start": (2.0, 2.0)},
    {"arena": ["yang", "random:1", "u_trap"]},
]
EMPTY = Arena("empty", np.empty((0, 3)), (10.0, 50.0), (90.0, 50.0), (0.0, 0.0, 100.0, 100.0), 1.0)
PILLAR = Arena("pillar", np.array([[50.0, 50.0, 5.0]]), (10.0, 50.0), (90.0, 50.0), (0.0, 0.0, 100.0, 100.0), 1.0)


def straight(env: gym.Env, steps: int) -> tuple[Any, float, bool, bool, dict[str, Any]]:
    """Drive straight on until the episode ends."""
    for _ in range(steps):
        last = env.step(np.zeros(1, np.float32))
        if last[2] or last[3]:
            break
    return last


@pytest.mark.parametrize("keywords", SPECS, ids=lambda keywords: str(keywords["arena"]))
def test_every_arena_passes_both_checkers(keywords: dict[str, Any]) -> None:
    from stable_baselines3.common.env_checker import check_env as check_for_sb3

    check_env(gym.make("lidarena/Arena-v0", **keywords).unwrapped)
    check_for_sb3(gym.make("lidarena/Arena-v0", **keywords))


@needs_barn
@pytest.mark.parametrize("arena", ["barn", "barn:30"])
def test_barn_worlds_pass_both_checkers(arena: str) -> None:
    from stable_baselines3.common.env_checker import check_env as check_for_sb3

    env = gym.make("lidarena/Arena-v0", arena=arena, path=str(BARN))
    check_env(env.unwrapped)
    check_for_sb3(env)


def test_a_step_is_a_metre_in_the_direction_of_the_turn() -> None:
    env = ArenaEnv(arena="yang")
    _, info = env.reset(seed=0)
    assert info["pose"] == pytest.approx([0.0, 0.0, math.pi / 4])
    heading = math.pi / 4
    for turn in (0.0, 0.25, -0.5, 1.0):
        place = info["pose"][:2]
        _, _, _, _, info = env.step(np.array([turn], np.float32))
        heading += turn * math.pi
        step = info["pose"][:2] - place
        assert step == pytest.approx([math.cos(heading), math.sin(heading)], abs=1e-6)
        assert -math.pi <= info["pose"][2] <= math.pi


def test_discrete_headings_are_sixteen() -> None:
    for k in (0, 3, 8, 15):
        env = ArenaEnv(arena="yang", action="discrete")
        env.reset(seed=0)
        _, _, _, _, info = env.step(k)
        assert math.remainder(info["pose"][2] - math.pi / 4 - k * math.pi / 8, 2 * math.pi) == pytest.approx(
            0, abs=1e-9
        )


def test_sizes_are_to_scale() -> None:
    small, large = ArenaEnv(arena="gnron"), ArenaEnv(arena="yang")
    assert large.step_length == pytest.approx(10 * small.step_length) == 1.0
    assert ArenaEnv(arena="env2", goal=(1.0, 6.5)).step_length == pytest.approx(0.1)
    assert ArenaEnv(arena="yang", robot={"max_speed": 2.0}, decision_period=0.25).step_length == 0.5


def test_the_straight_way_through_an_empty_room_reaches_the_goal() -> None:
    env = ArenaEnv(arena=EMPTY)
    env.reset(seed=0)
    _, reward, terminated, truncated, info = straight(env, 200)
    assert terminated and not truncated and info["success"] and not info["collision"]
    assert info["path_length"] == pytest.approx(79.0)
    assert info["time"] == pytest.approx(79.0)
    assert info["distance"] == pytest.approx(1.0)
    assert reward == pytest.approx(1.0 + 10.0 - 0.1)
    with pytest.raises(ResetNeeded, match="reset"):
        env.step(np.zeros(1, np.float32))


def test_a_pillar_on_the_straight_way_is_hit() -> None:
    env = ArenaEnv(arena=PILLAR)
    env.reset(seed=0)
    _, reward, terminated, _, info = straight(env, 200)
    assert terminated and info["collision"] and not info["success"]
    assert info["pose"][0] == pytest.approx(44.0, abs=0.05)  # the robot's and the pillar's radius off its middle
    assert info["clearance"] == 0.0
    assert info["reward_terms"]["collision"] == -10.0
    assert reward == pytest.approx(sum(info["reward_terms"].values()))


@pytest.mark.parametrize(("y", "hit"), [(56.01, False), (55.99, True)])
def test_contact_is_exact(y: float, hit: bool) -> None:
    arena = Arena("side", PILLAR.circles, (10.0, y), (90.0, y), PILLAR.bounds, 1.0)
    env = ArenaEnv(arena=arena)
    env.reset(seed=0)
    gaps = []
    for _ in range(100):
        _, _, terminated, _, info = env.step(np.zeros(1, np.float32))
        gaps.append(info["clearance"])
        if terminated:
            break
    assert info["collision"] is hit
    assert min(gaps) == pytest.approx(0.0 if hit else 0.01, abs=1e-6)


def test_walls_are_hit() -> None:
    env = ArenaEnv(arena=EMPTY, max_episode_steps=None)
    env.reset(seed=0)
    _, _, terminated, _, info = env.step(np.array([1.0], np.float32))
    while not terminated:
        _, _, terminated, _, info = env.step(np.zeros(1, np.float32))
    assert info["collision"]
    assert info["pose"][0] == pytest.approx(1.0, abs=0.05)


def test_the_observation_is_in_the_robots_frame() -> None:
    env = ArenaEnv(arena=PILLAR, start=(40.0, 50.0), goal=(40.0, 90.0))
    observation, info = env.reset(seed=0)  # heads for the goal, so the pillar is to the right
    assert observation[36:] == pytest.approx([40.0 / 150.0, 1.0, 0.0], abs=1e-6)
    assert observation[27] * 30.0 == pytest.approx(5.0)
    assert info["scan"][27] == pytest.approx(5.0)
    observation, *_ = env.step(np.array([0.5], np.float32))
    assert observation[18] * 30.0 == pytest.approx(6.0)  # now it is behind
    assert observation[37] == pytest.approx(-1 / math.hypot(1, 40), abs=1e-6)
    assert observation[38] == pytest.approx(-40 / math.hypot(1, 40), abs=1e-6)


def test_proximity_is_the_radius_over_the_range() -> None:
    ranges, near = (ArenaEnv(arena=PILLAR, start=(40.0, 50.0), observation=kind) for kind in ("ranges", "proximity"))
    seen, info = ranges.reset(seed=0)
    close, _ = near.reset(seed=0)
    assert close[:36] == pytest.approx(1.0 / info["scan"], rel=1e-6) and close[0] == pytest.approx(1.0 / 5.0)
    assert close[36:].tolist() == seen[36:].tolist()
    for _ in range(5):
        close, *_ = near.step(np.zeros(1, np.float32))
    assert close[0] == pytest.approx(1.0, abs=1e-3)  # contact


def test_reward_terms_are_weighted_by_keywords() -> None:
    weights = {"progress": 2.0, "time": 0.5, "clearance": 3.0, "turn": 4.0}
    env = ArenaEnv(arena=PILLAR, start=(43.0, 50.0), reward={"preset": "default", **weights})
    env.reset(seed=0)
    _, reward, _, _, info = env.step(np.array([0.5], np.float32))
    terms = info["reward_terms"]
    assert terms["time"] == -0.5
    assert terms["turn"] == pytest.approx(-2.0)
    assert terms["progress"] == pytest.approx(2.0 * (47.0 - math.hypot(47.0, 1.0)))
    assert terms["clearance"] == pytest.approx(3.0 * (info["clearance"] / 2.0 - 1.0))
    assert info["clearance"] == pytest.approx(1.0)
    assert reward == pytest.approx(sum(terms.values()))


def test_the_map_is_told_only_where_it_is_known() -> None:
    _, info = ArenaEnv(arena="yang").reset(seed=0)
    assert info["circles"].shape == (4, 3) and info["bounds"].tolist() == [-5.0, -5.0, 95.0, 95.0]
    _, info = ArenaEnv(arena="yang", knowledge="lidar").reset(seed=0)
    assert not {"circles", "bounds", "truth"} & set(info)
    _, info = ArenaEnv(arena="yang", knowledge="lidar", expose_truth=True).reset(seed=0)
    assert info["truth"]["circles"].shape == (4, 3) and "circles" not in info


def test_points_get_an_extent_that_a_lidar_sees() -> None:
    _, info = ArenaEnv(arena="gnron").reset(seed=0)
    assert info["circles"].tolist() == [[0.5, 0.0, 0.05]]
    assert info["radius"] == pytest.approx(0.01)


def test_families_draw_another_arena_every_time() -> None:
    env = ArenaEnv(arena="random", arenas=100, expose_truth=True)
    counts = [len(env.reset(seed=k)[1]["truth"]["circles"]) for k in range(6)]
    first = env.reset(seed=3)[1]["circles"].tobytes()
    assert len(set(counts)) > 1 and env.reset(seed=3)[1]["circles"].tobytes() == first
    assert env.reset()[1]["circles"].tobytes() != first


def test_by_seed_the_arena_is_the_one_of_that_number() -> None:
    env = ArenaEnv(arena="u_trap", pick="by_seed")
    for seed in (0, 7):
        assert np.array_equal(env.reset(seed=seed)[1]["circles"], load_arena(f"u_trap:{seed}").circles)
    env = ArenaEnv(arena=["yang", "random"], pick="by_seed", density=0.08)
    assert len(env.reset(seed=4)[1]["circles"]) == 4
    assert np.array_equal(env.reset(seed=5)[1]["circles"], load_arena("random:2", density=0.08).circles)
    assert env.floorplan.name == "random:2"


def test_drawn_arenas_are_none_that_a_seed_gives() -> None:
    env = ArenaEnv(arena="random")
    numbers = []
    for k in range(5):
        env.reset(seed=k)
        numbers.append(int(env.floorplan.name.partition(":")[2]))
    assert min(numbers) >= 2**31


def test_solvable_passes_over_arenas_without_a_path() -> None:
    options = {"arena": "random", "pick": "by_seed", "density": 0.3}
    any_, solvable = ArenaEnv(**options), ArenaEnv(**options, solvable=True)
    for env, number in ((any_, 66), (solvable, 66 + 2**32)):  # in random:66 a wall of circles parts start and goal
        env.reset(seed=66)
        assert env.floorplan.name == f"random:{number}"


@needs_barn
def test_barn_worlds_by_seed_are_those_of_the_file() -> None:
    env = ArenaEnv(arena="barn", path=str(BARN), pick="by_seed")
    env.reset(seed=3)
    assert env.floorplan.name == "barn:6"
    env.reset(seed=150)
    assert env.floorplan.name == "barn:0"


def test_pictures_show_the_arena() -> None:
    env = ArenaEnv(arena="yang:u", render_mode="rgb_array", field="traditional")
    with pytest.raises(ResetNeeded):
        env.render()
    env.reset(seed=0)
    env.step(np.zeros(1, np.float32))
    picture = env.render()
    assert picture is not None and picture.dtype == np.uint8 and picture.shape[2] == 3
    trap = (picture.astype(int) == (190, 24, 170)).all(axis=2)  # the traditional field has a minimum inside the U
    assert trap.sum() > 20
    batch = BatchedArena(2, arena="yang", render_mode="rgb_array")
    batch.reset(seed=0)
    assert len(batch.render() or ()) == 2
    assert BatchedArena(2, arena="yang").render() is None


@pytest.mark.parametrize("action", [np.nan, [0.0, 0.0], [2.0], "left", None, [np.nan], 0.5])
def test_bad_continuous_actions_are_refused(action: object) -> None:
    env = ArenaEnv(arena="yang")
    env.reset(seed=0)
    with pytest.raises(ActionError, match="action") as refusal:
        env.step(action)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("action", [16, -1, 0.5, np.nan, [0], "0", None, True])
def test_bad_discrete_actions_are_refused(action: object) -> None:
    env = ArenaEnv(arena="yang", action="discrete")
    env.reset(seed=0)
    with pytest.raises(ActionError, match="action"):
        env.step(action)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"aerna": "yang"}, "did you mean 'arena'"),
        ({"pick": "byseed"}, "did you mean 'by_seed'"),
        ({"action": "heading"}, "action = 'heading'"),
        ({"knowledge": "all"}, "knowledge"),
        ({"lidar": {"beams": 2}}, "lidar.beams = 2"),
        ({"lidar": {"beams": 36.5}}, "whole number"),
        ({"robot": {"max_speed": 0}}, "robot.max_speed = 0"),
        ({"robot": {"max_speed": float("nan")}}, "robot.max_speed = nan"),
        ({"goal_radius": -1.0}, "goal_radius"),
        ({"lidar": {"max_range": 0.0}}, "max_range"),
        ({"reward": {"progress": -1.0}}, "reward.progress"),
        ({"max_episode_steps": 0}, "max_episode_steps"),
        ({"density": 0.5}, "density = 0.5"),
        ({"density": []}, "density"),
        ({"arenas": 0}, "arenas = 0"),
        ({"solvable": 1}, "solvable"),
        ({"arena": []}, "arena"),
        ({"arena": 3}, "arena = 3"),
        ({"arena": "barn"}, "give its path"),
        ({"arena": "barn", "path": 5}, "path = 5"),
        ({"arena": ["yang", "gnron"]}, "scale"),
        ({"field": "robots"}, "did you mean 'robust'"),
    ],
)
def test_bad_keywords_are_refused_in_one_sentence(keywords: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=message) as refusal:
        ArenaEnv(**keywords)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"arena": "yang", "start": (40.0, 45.0)}, "start .* inside the obstacle"),
        ({"arena": "yang", "goal": (10.0, 90.2)}, "goal .* inside the obstacle"),
        ({"arena": "yang", "goal": (200.0, 0.0)}, "wall"),
        ({"arena": "env2"}, "no goal of its own"),
        ({"arena": "yangg"}, "did you mean 'yang"),
        ({"arena": "barn:3", "path": "nowhere.npz"}, "not there"),
        ({"arena": "random:x"}, "seed 'x'"),
    ],
)
def test_bad_arenas_are_refused_in_one_sentence(keywords: dict[str, Any], message: str) -> None:
    with pytest.raises(MapError, match=message) as refusal:
        ArenaEnv(**keywords)
    assert "\n" not in str(refusal.value)


@needs_barn
def test_a_barn_world_that_is_not_in_the_file_is_refused() -> None:
    with pytest.raises(MapError, match="world 7 is not in BARN file"):
        ArenaEnv(arena="barn:7", path=str(BARN))


def test_gym_makes_own_limit_truncates_in_every_mode() -> None:
    env = gym.make("lidarena/Arena-v0", arena="yang", max_episode_steps=3)
    env.reset(seed=0)
    assert [env.step(np.zeros(1, np.float32))[3] for _ in range(3)] == [False, False, True]
    assert gym.make("lidarena/Arena-v0").spec.max_episode_steps == 500  # type: ignore[union-attr]
