import numpy as np
import pytest

from lidarena.base.errors import ActionError
from lidarena.envs.workshop.env import WorkshopEnv
from lidarena.envs.workshop.episodes import WorkshopEpisodes
from lidarena.envs.workshop.options import WorkshopOptions
from tests.envs.workshop.workshops import Sleeper, chain, loose, play


def episodes(worlds: int = 3, **keywords: object) -> WorkshopEpisodes:
    made = WorkshopEpisodes(worlds, WorkshopOptions.checked({"task": loose(3)} | keywords))
    made.reset(range(worlds), [np.random.default_rng(k) for k in range(worlds)])
    return made


def test_every_step_ends_where_the_robot_decides() -> None:
    made = episodes()
    for _ in range(3):
        masks = made.action_masks()
        assert masks.shape == (3, 4) and masks.any(axis=1).all()
        rewards, terminated, _ = made.step(masks.argmax(axis=1))
        running = ~terminated
        assert made.core.workers.due[running, 1].all() and (rewards < 0.0)[running].all()


def test_durations_add_up_to_the_time() -> None:
    made, total = episodes(1), 0.0
    over = False
    while not over:
        _, terminated, truncated = made.step(made.action_masks().argmax(axis=1))
        total += made.infos()["duration"][0]
        over = bool(terminated[0] or truncated[0])
    assert total == pytest.approx(made.infos()["time"][0])


def test_what_may_not_be_done_is_counted_as_waiting() -> None:
    made = episodes(1)
    taken = made.infos()["doing"][0, 0]
    made.step([taken])
    assert made.infos()["refused"][0] == 1 and made.infos()["agent"][0, taken] == 0
    with pytest.raises(ActionError, match="out of range"):
        made.step([4])


def test_time_and_decisions_are_limited() -> None:
    late = episodes(1, human=Sleeper, time_limit=12.0, wait_period=5.0)
    outcomes = [late.step([3]) for _ in range(3)]
    assert [bool(truncated[0]) for _, _, truncated in outcomes] == [False, False, True]
    assert outcomes[-1][0][0] < -10.0  # nothing was done
    few = episodes(1, max_episode_steps=2, human=Sleeper)
    assert [bool(few.step([3])[2][0]) for _ in range(2)] == [False, True]


def test_a_deadline_that_nobody_can_meet_does_not_cut_the_episode_off() -> None:
    hopeless = chain(3) | {"deadline": 2.0}
    info = play(WorkshopEnv(task=hopeless, human="free"), seed=0)[-1]
    assert info["success"] and not info["deadline_met"] and info["time"] > 12.0
