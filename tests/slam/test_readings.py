import threading

import numpy as np

from lidarena.base.jit import leaf
from lidarena.envs import ExplorationEnv
from lidarena.slam.readings import Share, next_world, reading_of
from lidarena.world.sensors import Sensing


@leaf
def visit(share: Share, visits: np.ndarray) -> None:
    w = next_world(share)
    while w < share.last:
        visits[w, share.thread] += 1
        w = next_world(share)


def test_threads_share_the_worlds_between_them() -> None:
    visits, counter, active = np.zeros((500, 4), np.int64), np.array([3]), np.arange(500) % 7 != 0
    threads = [threading.Thread(target=visit, args=(Share(counter, 500, k, active), visits)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not visits[:3].any() and (visits[3:].sum(axis=1) == active[3:]).all()


@leaf
def read(w: int, sensing: Sensing) -> tuple:
    reading = reading_of(w, sensing)
    return reading.duration, reading.motion[0], reading.scan[3], reading.fresh


def test_a_reading_is_what_the_sensors_of_its_world_say() -> None:
    env = ExplorationEnv(map="env1", slam="truth")
    env.reset(seed=0)
    env.step(0)
    core = env.episodes.core
    rest = (core.plan, core.streams, core._noise, core.beam, 0.1, core.lidar.geometry, core.lidar.directions)
    sensing = Sensing(core.physics.poses, core.physics.poses, *rest, core.sensors, 0.2)
    duration, motion, scan, fresh = read(0, sensing)
    assert duration == 0.2 and fresh
    assert motion == core.sensors.readings[0, 0, 0] and scan == core.sensors.scans[0, 0, 3]
