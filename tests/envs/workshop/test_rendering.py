import numpy as np

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
    chart = after[-100:-40]
    assert (chart != before[-100:-40]).any()
    batch = BatchedWorkshop(2, render_mode="rgb_array")
    batch.reset(seed=0)
    assert len(batch.render() or ()) == 2 and BatchedWorkshop(1).render() is None
