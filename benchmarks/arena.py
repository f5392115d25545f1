"""Arena steps a second: 64 worlds with 36 beams, beside a naive loop over pymunk's own rays in the same run.

python benchmarks/arena.py [--steps 3000] [--arena random] [--arenas 500]

Both drive alike: for the goal, as far as the beams leave room. A second is one of the processor's
(``time.process_time``) on one thread, so that other work on the machine does not count; the second column is by the
clock. Collisions and resets are included; a new arena costs a millisecond once, when an episode first draws it.
"""

import argparse
import math
import time
from collections.abc import Callable

import gymnasium as gym
import numpy as np
import pymunk
from numpy.typing import NDArray

import lidarena  # noqa: F401
from lidarena.base.terminal import make_output_printable
from lidarena.world.arenas import Arena, load_arena

WORLDS, NAIVE_WORLDS, BEAMS, REACH = 64, 8, 36, 30.0
Floats = NDArray[np.float32]
ANGLES = np.arange(BEAMS) * (2.0 * np.pi / BEAMS)
APART = ANGLES[:, None] - ANGLES
WIDTH = 1.6
"""Half of the way that the driver wants free [m]."""


def drive(observations: Floats) -> Floats:
    """Turns over π (worlds, 1): of the directions with most room for a robot of 1 m the one nearest to the goal's."""
    ranges, bearing = (
        REACH * observations[:, :BEAMS],
        np.arctan2(observations[:, BEAMS + 2], observations[:, BEAMS + 1]),
    )
    ahead, aside = ranges[:, None] * np.cos(APART), ranges[:, None] * np.abs(np.sin(APART))
    room = np.where((aside < WIDTH) & (ahead > 0.0), ahead, REACH).min(axis=2)  # (worlds, directions)
    away = np.abs(np.angle(np.exp(1j * (ANGLES - bearing[:, None]))))
    best = ANGLES[np.argmax(np.minimum(room, 8.0) - 1.5 * away, axis=1)]
    return np.clip(np.angle(np.exp(1j * best)) / np.pi, -1.0, 1.0).astype(np.float32)[:, None]


class NaiveArenas:
    """What one would write first: a loop over worlds, 10 pymunk steps, one ``segment_query_first`` a beam."""

    def __init__(self, arena: Arena, worlds: int) -> None:
        self._arena = arena
        self._worlds = [self._build(arena) for _ in range(worlds)]

    @staticmethod
    def _build(arena: Arena) -> tuple[pymunk.Space, pymunk.Body]:
        space = pymunk.Space()
        for x, y, radius in arena.circles.tolist():
            space.add(pymunk.Circle(space.static_body, radius, (x, y)))
        x0, y0, x1, y1 = arena.bounds
        for a, b in (((x0, y0), (x1, y0)), ((x1, y0), (x1, y1)), ((x1, y1), (x0, y1)), ((x0, y1), (x0, y0))):
            space.add(pymunk.Segment(space.static_body, a, b, 0.0))
        body = pymunk.Body(1.0, 1.0)
        shape = pymunk.Circle(body, max(arena.robot_radius, 0.1))
        shape.filter = pymunk.ShapeFilter(categories=2)
        space.add(body, shape)
        body.position, body.angle = (
            arena.start,
            math.atan2(arena.goal[1] - arena.start[1], arena.goal[0] - arena.start[0]),
        )
        return space, body

    def step(self, actions: Floats) -> Floats:
        """Observations (worlds, beams + 3) after one decision."""
        out = np.zeros((len(self._worlds), BEAMS + 3), np.float32)
        obstacles = pymunk.ShapeFilter(mask=pymunk.ShapeFilter.ALL_MASKS() ^ 2)
        for i, (space, body) in enumerate(self._worlds):
            body.angle += math.pi * float(actions[i, 0])
            for _ in range(10):
                body.velocity, body.angular_velocity = (math.cos(body.angle), math.sin(body.angle)), 0.0
                space.step(0.1)
            (x, y), (gx, gy) = body.position, self._arena.goal
            for k in range(BEAMS):
                angle = body.angle + ANGLES[k]
                end = (x + REACH * math.cos(angle), y + REACH * math.sin(angle))
                hit = space.segment_query_first((x, y), end, 0, obstacles)
                out[i, k] = hit.alpha if hit is not None else 1.0
            bearing = math.atan2(gy - y, gx - x) - body.angle
            distance = math.hypot(gx - x, gy - y)
            out[i, BEAMS:] = distance / 150.0, math.cos(bearing), math.sin(bearing)
            if distance < 1.0 or out[i, :BEAMS].min() * REACH < self._arena.robot_radius + 0.02:
                body.position = self._arena.start
        return out


def rates(step: Callable[[Floats], Floats], worlds: int, steps: int) -> tuple[float, float]:
    """Steps a second of the processor and of the clock after a short run-up, the driver's own time left out."""
    observations = np.ones((worlds, BEAMS + 3), np.float32)
    processor = clock = 0.0
    for k in range(steps + max(steps // 10, 2)):
        actions = drive(observations)
        begin, began = time.process_time(), time.perf_counter()
        observations = step(actions)
        if k >= max(steps // 10, 2):
            processor += time.process_time() - begin
            clock += time.perf_counter() - began
    return worlds * steps / processor, worlds * steps / clock


def main() -> None:
    """Print the table."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--arena", default="random", help="such as yang:u, or a family: random, u_trap")
    parser.add_argument("--arenas", type=int, default=500, help="how many of a family are drawn from")
    options = parser.parse_args()
    fixed = options.arena if ":" in options.arena or options.arena == "yang" else f"{options.arena}:0"
    naive = rates(NaiveArenas(load_arena(fixed), NAIVE_WORLDS).step, NAIVE_WORLDS, 60)
    print(f"{'':34} {'steps/s, one core':>18} {'by the clock':>14}")
    print(f"{'naive pymunk loop, 36 rays':34} {naive[0]:18,.0f} {naive[1]:14,.0f}")
    batch = gym.make_vec("lidarena/Arena-v0", WORLDS, "vector_entry_point", arena=options.arena, arenas=options.arenas)
    batch.reset(seed=0)
    found = rates(lambda actions: batch.step(actions)[0], WORLDS, options.steps)
    print(f"{f'lidarena, {WORLDS} worlds, {options.arena}':34} {found[0]:18,.0f} {found[1]:14,.0f}", end="")
    print(f"   {found[0] / naive[0]:.0f} ×", flush=True)


if __name__ == "__main__":
    main()
