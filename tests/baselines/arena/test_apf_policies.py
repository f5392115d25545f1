"""The policies for arenas, driven in the real environment: what each is for, and what it must never do."""

import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.base.errors import ConfigError
from lidarena.baselines.policy import Policy
from tests.baselines.arena.arena_drives import EMPTY, KNOWN, LIDAR, NO_WAY, drive, over_astar
from tests.planning.potential_field.test_potential_field import BARN, needs_barn


@pytest.mark.parametrize("policy", KNOWN + LIDAR)
def test_every_policy_is_one_and_drives_straight_through_an_empty_room(policy: str) -> None:
    env = gym.make("lidarena/Arena-v0", arena=EMPTY)
    assert isinstance(lidarena.baselines.make(policy, env), Policy)
    end, info = drive(policy, arena=EMPTY)
    assert end == "success" and info["path_length"] == pytest.approx(
        79.0, abs=1.1
    )  # A* starts and ends beside the line


@pytest.mark.parametrize("policy", ["astar", "apf_improved", "apf_global"])
@pytest.mark.parametrize("arena", ["yang", "yang:arc", "yang:u"])
def test_planners_arrive_where_the_paper_sets_traps(policy: str, arena: str) -> None:
    end, info = drive(policy, arena=arena)
    assert end == "success"
    assert info["path_length"] + info["distance"] <= (1.12 if policy == "astar" else 1.05) * math.hypot(70, 70)
    assert info["least"] > (0.1 if policy == "astar" else 1.4)


@pytest.mark.parametrize("policy", ["astar", "apf_improved", "apf_global", "apf_improved_lidar"])
def test_u_traps_hold_nobody_who_plans(policy: str) -> None:
    for seed in range(4):
        assert drive(policy, seed, arena="u_trap", pick="by_seed")[0] == "success"


@pytest.mark.parametrize("policy", ["astar", "apf_improved", "apf_global"])
def test_dense_arenas_are_crossed_on_a_short_way(policy: str) -> None:
    ratios = []
    for seed in range(6):
        options = {"arena": "random", "density": 0.22, "pick": "by_seed", "solvable": True}
        end, info = drive(policy, seed, **options)
        assert end == "success" and info["least"] > 0.0
        env = gym.make("lidarena/Arena-v0", **options)
        start = env.reset(seed=seed)[1]["pose"][:2]
        ratios.append(over_astar(info, start))
    assert np.mean(ratios) < 1.05


@needs_barn
@pytest.mark.parametrize("policy", ["astar", "apf_improved", "apf_global", "apf_improved_lidar"])
def test_barn_worlds_are_crossed(policy: str) -> None:
    for seed in (0, 60):
        assert drive(policy, seed, arena="barn", path=str(BARN), pick="by_seed")[0] == "success"


@pytest.mark.parametrize("policy", ["apf_improved", "astar"])
def test_discrete_headings_do_too(policy: str) -> None:
    assert drive(policy, arena="yang:u", action="discrete")[0] == "success"


@pytest.mark.parametrize("policy", ["astar", "apf_improved", "apf_global"])
def test_where_there_is_no_way_planners_stop_without_a_collision(policy: str) -> None:
    options = {"field": {"attempts": 1, "ways": 1, "max_steps": 3000}} if policy == "apf_improved" else {}
    assert drive(policy, options=options, arena=NO_WAY)[0] == "finished"


@pytest.mark.parametrize("policy", KNOWN)
def test_planners_refuse_an_unknown_world(policy: str) -> None:
    with pytest.raises(ConfigError, match=f"'{policy}' plans with the obstacles known.*apf_improved_lidar"):
        drive(policy, arena="yang", knowledge="lidar")


@pytest.mark.parametrize("policy", KNOWN + LIDAR)
def test_an_episode_leaves_nothing_behind(policy: str) -> None:
    env = gym.make("lidarena/Arena-v0", arena="random", density=0.15, pick="by_seed")
    driver = lidarena.baselines.make(policy, env)

    def actions(seed: int) -> list[float]:
        observation, info = env.reset(seed=seed)
        driver.reset(seed=0)
        out = []
        for _ in range(8):
            action = driver.act(observation, info)
            out.append(float(action[0]))
            observation, _, _, _, info = env.step(action)
        return out

    first = actions(2)
    actions(6)
    assert actions(2) == first


@pytest.mark.parametrize(
    ("policy", "options", "message"),
    [
        ("apf_improved", {"preset": "robst"}, "did you mean 'robust'"),
        ("apf_improved", {"field": {"fil_shape": "bump"}}, "did you mean 'fill_shape'"),
        ("apf_improved", {"field": {"k": -1.0}}, "k = -1.0"),
        ("apf_improved", {"presets": "paper"}, "did you mean 'preset'"),
        ("apf_improved_lidar", {"spare": 2.0}, "spare = 2.0"),
        ("apf_improved_lidar", {"ways": 4}, "ways = 4"),
        ("apf", {"preset": "paper"}, "no option 'preset'"),
    ],
)
def test_bad_options_are_refused_in_one_sentence(policy: str, options: dict[str, Any], message: str) -> None:
    env = gym.make("lidarena/Arena-v0", arena="yang")
    with pytest.raises(ConfigError, match=message) as refusal:
        lidarena.baselines.make(policy, env, **options)
    assert "\n" not in str(refusal.value)


def test_arena_policies_drive_no_explorer() -> None:
    with pytest.raises(ConfigError, match="drives arena environments only"):
        lidarena.baselines.make("apf", gym.make("lidarena/Env1-v0", slam="truth"))
