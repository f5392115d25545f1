"""What two do in a workshop in time: ways, work, waiting, and the distance between them."""

import numpy as np
import pytest

from lidarena.envs.workshop.env import WorkshopEnv
from lidarena.envs.workshop.kernels import AWAY, DONE, IDLE, WAITING, WALKING, WORKING
from tests.envs.workshop.workshops import Sleeper, action, chain, first_allowed, loose, play, task_of


def test_a_robot_alone_walks_works_and_is_done() -> None:
    task = task_of({"x": action(["a", "table"], robot=(6, 8))})
    env = WorkshopEnv(task=task, human=Sleeper, expose_truth=True)
    infos = play(env)
    walk = (np.hypot(6, 4) + np.hypot(4, 2)) / 0.5
    assert infos[-1]["time"] == pytest.approx(walk + 6.0, rel=0.06)
    assert infos[-1]["worked"][0] == 6.0 and infos[-1]["path_length"][1] == pytest.approx(0.5 * walk, rel=0.06)
    log = infos[-1]["truth"]["log"][: infos[-1]["truth"]["logged"]]
    assert log[log[:, 0] == 1, 1].tolist() == [WALKING, WORKING, WALKING, WORKING, IDLE]
    assert infos[-1]["pose"][1, :2] == pytest.approx([5.0, 3.0], abs=1e-6)


def test_the_last_work_waits_for_what_comes_before() -> None:
    for seed in range(5):
        info = play(WorkshopEnv(task=chain(4), human="free"), seed=seed)[-1]
        assert (info["status"] == DONE).all()
        assert (info["placed"][1:] >= info["ended"][:-1] - 1e-9).all()
        assert (info["begun"][1:] >= info["begun"][:-1]).all()


def test_the_two_keep_their_distance() -> None:
    for separation in (0.2, 0.8):
        env = WorkshopEnv(task="cabinet", human="free", separation=separation)
        gaps = [play(env, seed=seed)[-1]["separation"] for seed in range(6)]
        assert min(gaps) >= separation - 0.02
        assert min(gaps) < 2.0


def test_bodies_are_solid_where_no_distance_is_kept() -> None:
    shared = task_of({f"x{k}": action("b") for k in range(3)})
    env = WorkshopEnv(task=shared, human="free", separation=0.0)
    gaps = [play(env, seed=seed)[-1]["separation"] for seed in range(2)]
    assert min(gaps) > -0.02


def test_nobody_is_stuck_in_a_passage() -> None:
    """Both have to pass a door that is too narrow for two, in opposite directions."""
    floor = {"bounds": [0, 0, 8, 6], "walls": [[4, 0, 4, 2.5], [4, 3.5, 4, 6]]}
    task = task_of(
        {f"p{k}": action(["abcd"[k % 4], "abcd"[(k + 2) % 4]]) for k in range(6)}, floor=floor, deadline=200.0
    )
    for seed in range(4):
        info = play(WorkshopEnv(task=task, human="free"), seed=seed)[-1]
        assert info["success"]


def test_one_location_is_for_one_at_a_time() -> None:
    shared = task_of({f"x{k}": action("b", human=(8, 9), robot=(8, 9)) for k in range(4)})
    for seed in range(3):
        info = play(WorkshopEnv(task=shared, human="free"), seed=seed)[-1]
        order = np.argsort(info["placed"])
        assert (info["placed"][order][1:] >= info["ended"][order][:-1] - 0.2).all()


def test_an_absent_human_leaves_and_comes_back() -> None:
    env = WorkshopEnv(task="gearbox", human="absent", expose_truth=True)
    seen = set()
    for seed in range(4):
        for info in play(env, seed=seed):
            seen |= {bool(info["human_present"])}
            truth = info["truth"]
        phases = truth["log"][: truth["logged"]]
        away = phases[(phases[:, 0] == 0) & (phases[:, 1] == AWAY)]
        assert len(away) <= 1
    assert seen == {True, False}


def test_waiting_ends_when_something_happens_or_after_its_period() -> None:
    env = WorkshopEnv(task=loose(2), human=Sleeper, wait_period=7.0)
    env.reset(seed=0)
    _, _, _, _, after = env.step(2)
    assert after["duration"] == pytest.approx(7.0, abs=0.11) or after["duration"] <= 7.0
    env = WorkshopEnv(task=loose(3), human="free", wait_period=600.0)
    env.reset(seed=0)
    _, _, _, _, after = env.step(3)
    assert after["duration"] < 30.0 and (after["status"] == DONE).sum() == 1


def test_idle_and_joint_time_add_up() -> None:
    info = play(WorkshopEnv(task="gearbox", human="free"), first_allowed, seed=3)[-1]
    busy = 1.0 - info["human_idle"] + 1.0 - info["robot_idle"]
    assert busy >= info["concurrent"] >= busy - 1.0 - 1e-9
    assert WAITING != IDLE
