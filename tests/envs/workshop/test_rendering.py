from itertools import pairwise

import numpy as np
import pytest

from lidarena.envs.workshop.env import BatchedWorkshop, WorkshopEnv
from lidarena.envs.workshop.kernels import AWAY, IDLE, WAITING, WALKING, WORKING
from lidarena.envs.workshop.rendering import AGENT_COLOURS, PHASES, segments, shade


def test_segments_are_what_lies_between_changes() -> None:
    log = np.array([[0, WALKING, 2, 0.0], [1, WALKING, 1, 1.0], [0, WORKING, 2, 4.0], [0, IDLE, -1, 9.0]])
    assert segments(log, 4, 12.0) == [
        (0, WALKING, 2, 0.0, 4.0),
        (1, IDLE, -1, 0.0, 1.0),
        (1, WALKING, 1, 1.0, 12.0),
        (0, WORKING, 2, 4.0, 9.0),
        (0, IDLE, -1, 9.0, 12.0),
    ]
    assert segments(log, 0, 5.0) == [(0, IDLE, -1, 0.0, 5.0), (1, IDLE, -1, 0.0, 5.0)]


def test_what_somebody_does_can_be_told_apart() -> None:
    assert (
        len({shade(AGENT_COLOURS[0], phase) for phase in PHASES}) == 5 == len({IDLE, WALKING, WAITING, WORKING, AWAY})
    )


def test_pictures_show_the_two_and_their_schedule() -> None:
    env = WorkshopEnv(task="gearbox", human="free", render_mode="rgb_array")
    env.reset(seed=0)
    before = env.render()
    for _ in range(3):
        env.step(int(np.flatnonzero(env.action_masks())[0]))
    after = env.render()
    assert after.dtype == np.uint8 and after.shape == before.shape and after.shape[2] == 3
    floor = after[48 : 48 + 420]
    for colour in AGENT_COLOURS:
        assert (np.abs(floor.astype(int) - colour).sum(axis=2) < 12).sum() > 200
    chart = slice(48 + 420, 48 + 420 + 68)
    assert (after[chart] != before[chart]).any()
    batch = BatchedWorkshop(2, render_mode="rgb_array")
    batch.reset(seed=0)
    assert len(batch.render() or ()) == 2 and BatchedWorkshop(1).render() is None


def test_a_film_shows_what_happened_within_a_step() -> None:
    env = WorkshopEnv(task="gearbox", human="free", render_mode="rgb_array", expose_truth=True)
    env.reset(seed=0)
    for _ in range(2):
        _, _, _, _, info = env.step(int(np.flatnonzero(env.action_masks())[0]))
    moments = env.moments
    assert np.allclose(np.diff(moments), 0.5) and len(moments) >= 3
    assert info["time"] - info["duration"] < moments[0] and moments[-1] <= info["time"] < moments[-1] + 0.5
    pictures = [env.render_at(time) for time in moments]
    assert all((one != other).any() for one, other in pairwise(pictures))
    trace = env.episodes.core.workers.trace[0]
    if moments[-1] == info["time"]:
        assert np.array_equal(trace[round(moments[-1] / 0.5)], info["pose"])
    walked = np.hypot(*np.diff(trace[: round(moments[-1] / 0.5) + 1, :, :2], axis=0).T).sum(axis=1)
    assert walked == pytest.approx(info["path_length"], rel=0.1)
    assert WorkshopEnv(task="gearbox").moments == []
