"""Environment steps a second: 64 worlds, SLAM live or with known poses, beside a naive environment with pymunk's rays.

python benchmarks/environment.py [--steps 600] [--env lidarena/Env3-v0]

All rivals drive the same way: straight on, with a random turn now and then, and away from what is close ahead.
"""

import argparse
import math
import time
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import pymunk
from numpy.typing import NDArray

import lidarena  # noqa: F401
from lidarena.base.terminal import make_output_printable
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan

WORLDS = 64


class Wanderer:
    """Keeps a batch of robots off the walls with the three actions, from the five front beams."""

    def __init__(self, worlds: int) -> None:
        self._rng = np.random.default_rng(0)
        self._turning = np.zeros(worlds, np.int64)

    def __call__(self, observations: NDArray[np.float32]) -> NDArray[np.int64]:
        """Actions (worlds,) for observations (worlds, 7)."""
        front, left, right = observations[:, 0], observations[:, 1], observations[:, 3]
        blocked = (front < 0.16) | (np.minimum(left, right) < 0.08) | (self._rng.random(len(front)) < 0.02)
        start = blocked & (self._turning == 0)
        self._turning[start] = np.where(left > right, 1, 2)[start]
        clear = (front > 0.25) & (np.minimum(left, right) > 0.09)
        stop = (self._turning > 0) & clear & (self._rng.random(len(front)) < 0.4)
        self._turning[stop] = 0
        return self._turning.copy()


class NaiveWorlds:
    """What one would write first: a loop over worlds, 5 pymunk steps, one ``segment_query_first`` a beam, no SLAM."""

    def __init__(self, plan: Floorplan, worlds: int) -> None:
        self._plan = plan
        self._worlds = [self._build(plan) for _ in range(worlds)]

    @staticmethod
    def _build(plan: Floorplan) -> tuple[pymunk.Space, pymunk.Body]:
        space = pymunk.Space()
        for x1, y1, x2, y2 in plan.edges.tolist():
            space.add(pymunk.Segment(space.static_body, (x1, y1), (x2, y2), 0.0))
        body = pymunk.Body(1.0, 1.0)
        shape = pymunk.Circle(body, 0.105)
        shape.filter = pymunk.ShapeFilter(categories=2)
        space.add(body, shape)
        body.position, body.angle = plan.start[:2], plan.start[2]
        return space, body

    def step(self, actions: NDArray[np.int64]) -> NDArray[np.float32]:
        """Observations (worlds, 7) after one decision."""
        out = np.zeros((len(self._worlds), 7), np.float32)
        walls = pymunk.ShapeFilter(mask=pymunk.ShapeFilter.ALL_MASKS() ^ 2)
        for i, (space, body) in enumerate(self._worlds):
            speed, rate = ((0.5, 0.0), (0.05, 0.3), (0.05, -0.3))[actions[i]]
            for _ in range(5):
                body.velocity = (speed * math.cos(body.angle), speed * math.sin(body.angle))
                body.angular_velocity = rate
                space.step(0.04)
            x, y = body.position
            ranges = np.full(360, 3.5)
            for k in range(360):
                angle = body.angle + k * math.pi / 180
                end = (x + 3.5 * math.cos(angle), y + 3.5 * math.sin(angle))
                hit = space.segment_query_first((x, y), end, 0, walls)
                if hit is not None:
                    ranges[k] = 3.5 * hit.alpha
            out[i, :5] = ranges[[0, 45, 90, 315, 270]] / 3.5
            if ranges.min() < 0.12:
                body.position, body.angle = self._plan.start[:2], self._plan.start[2]
        return out


def rate(step: Callable[[NDArray[np.int64]], NDArray[np.float32]], worlds: int, steps: int) -> float:
    """Steps a second after a short run-up."""
    drive, observations = Wanderer(worlds), np.ones((worlds, 7), np.float32)
    for _ in range(max(steps // 10, 2)):
        observations = step(drive(observations))
    begin = time.perf_counter()
    for _ in range(steps):
        observations = step(drive(observations))
    return worlds * steps / (time.perf_counter() - begin)


def main() -> None:
    """Print the table."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=600)
    parser.add_argument("--env", default="lidarena/Env3-v0")
    options = parser.parse_args()
    plan = load_floorplan("env" + options.env.split("Env")[1][0])
    naive = NaiveWorlds(plan, 8)
    reference = rate(naive.step, 8, 30)
    print(f"{'naive pymunk loop, 360 rays, no SLAM':44} {reference:9,.0f} steps/s    1.0×")
    kinds: dict[str, dict[str, Any]] = {"30-particle SLAM live": {}, "slam='truth'": {"slam": "truth"}}
    for label, keywords in kinds.items():
        batch = gym.make_vec(options.env, WORLDS, "vector_entry_point", **keywords)
        batch.reset(seed=0)
        value = rate(lambda actions, batch=batch: batch.step(actions)[0], WORLDS, options.steps)  # type: ignore[misc]
        print(f"{f'lidarena, {WORLDS} worlds, {label}':44} {value:9,.0f} steps/s {value / reference:6.1f}×", flush=True)


if __name__ == "__main__":
    main()
