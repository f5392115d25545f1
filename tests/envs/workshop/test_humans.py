"""Humans: what they are like, and those of one's own."""

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.envs.workshop.env import WorkshopEnv
from lidarena.envs.workshop.humans import EXTERNAL, KINDS, choose_human, draw_traits
from lidarena.envs.workshop.task import load_task
from tests.envs.workshop.workshops import Rebel, Sleeper, action, loose, play, task_of


def traits(kind: str, seed: int = 0):
    return draw_traits(kind, np.random.default_rng(seed), load_task("gearbox"))


def test_kinds_differ_in_what_they_are_called_for() -> None:
    assert traits("free")[0].urgency == 0.0 and traits("helpful")[0].urgency > 0.0
    assert all(traits("slow", seed)[0].pace >= 1.4 for seed in range(9))
    leaving, staying = traits("absent")[0], traits("free")[0]
    assert leaving.leaves_at < 200.0 < staying.leaves_at and leaving.away_time > 30.0
    assert not traits("free")[2].any() and any(traits("stubborn", seed)[2].any() for seed in range(5))


def test_nobody_refuses_what_only_a_human_can_do() -> None:
    task = load_task("gearbox")
    alone = task.arrays.capable[0] & ~task.arrays.capable[1]
    assert alone.any() and not any((traits("stubborn", seed)[2] & alone).any() for seed in range(30))


def test_a_mixture_draws_all_kinds() -> None:
    drawn = [traits("mixture", seed) for seed in range(60)]
    assert any(one[0].leaves_at < np.inf for one in drawn) and any(one[0].pace > 1.3 for one in drawn)
    assert any(one[0].urgency > 0 for one in drawn) and any(one[2].any() for one in drawn)
    assert len({one[0].pace for one in drawn}) > 40


def test_a_seed_fixes_a_human() -> None:
    first, second = traits("mixture", 3), traits("mixture", 3)
    assert first[0] == second[0] and np.array_equal(first[1], second[1])


def test_free_humans_choose_evenly() -> None:
    env = WorkshopEnv(task=loose(3), human="free")
    counts = np.zeros(3)
    for seed in range(150):
        counts[env.reset(seed=seed)[1]["doing"][0]] += 1
    assert counts.min() > 30  # 50 each


def test_durations_are_within_the_bounds_nine_times_in_ten() -> None:
    env = WorkshopEnv(task=task_of({"x": action("a", human=(4, 9), robot=None)}), expose_truth=True)
    broken = np.mean([play(env, seed=seed)[-1]["bounds_broken"] for seed in range(200)])
    assert 0.04 < broken < 0.18


def test_ones_own_human_is_asked_and_may_do_as_it_likes() -> None:
    infos = play(WorkshopEnv(task=loose(3), human=Sleeper))
    assert (infos[-1]["agent"] == 1).all() and infos[-1]["human_idle"] == pytest.approx(1.0)
    chain = task_of({"x": action("a"), "y": action("b", after=["x"]), "z": action("c", human=None, after=["y"])})
    last = play(WorkshopEnv(task=chain, human=Rebel()))[-1]
    assert last["success"] and last["unplanned"] >= 1 and last["agent"][2] == 0


def test_a_function_or_a_name_in_a_module_is_a_human() -> None:
    play(WorkshopEnv(task=loose(2), human=lambda info, rng: None))
    assert isinstance(choose_human("tests.envs.workshop.workshops:Sleeper"), Sleeper)
    assert choose_human(EXTERNAL) == EXTERNAL and all(choose_human(kind) == kind for kind in KINDS)


@pytest.mark.parametrize("wrong", ["fre", 3, "tests.envs.workshop.workshops:Nobody", object()])
def test_humans_that_there_are_not_are_refused(wrong: object) -> None:
    with pytest.raises(ConfigError, match=r"human = |Nobody"):
        choose_human(wrong)


def test_a_choice_that_there_is_not_is_refused() -> None:
    with pytest.raises(ConfigError, match="chose 99"):
        WorkshopEnv(task=loose(2), human=lambda info, rng: 99).reset(seed=0)
