"""Agent steps a second: 64 teams of 4 robots with 36 beams each, beside a naive loop over pymunk worlds.

python benchmarks/corridor.py [--steps 600]

Both drive along the robots' shortest ways, slower before what is close ahead. Wall-clock and processor time.
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
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan
from lidarena.world.team_drawings import team_places

TEAMS, ROBOTS, BEAMS = 64, 4, 36
BAR = 40_000


class NaiveTeams:
    """What one would write first: a loop over worlds, 5 pymunk steps, one ``segment_query_first`` a beam, no ways."""

    def __init__(self, plan: Floorplan, teams: int) -> None:
        self._rng = np.random.default_rng(0)
        places = team_places(plan.name)
        assert places is not None
        self._places = places.starts
        self._teams = [self._build(plan) for _ in range(teams)]

    def _build(self, plan: Floorplan) -> tuple[pymunk.Space, list[pymunk.Body]]:
        space = pymunk.Space()
        for x1, y1, x2, y2 in plan.edges.tolist():
            space.add(pymunk.Segment(space.static_body, (x1, y1), (x2, y2), 0.0))
        bodies = []
        for number, place in enumerate(self._rng.permutation(len(self._places))[:ROBOTS]):
            body = pymunk.Body(1.0, 1.0)
            shape = pymunk.Circle(body, 0.105)
            shape.filter = pymunk.ShapeFilter(categories=1 << number)
            space.add(body, shape)
            body.position = tuple(self._places[place].tolist())
            bodies.append(body)
        return space, bodies

    def step(self, actions: NDArray[np.float32]) -> NDArray[np.float32]:
        """Scans (robots, beams) after one decision of every robot (robots, 2)."""
        out = np.ones((len(actions), BEAMS), np.float32)
        for world, (space, bodies) in enumerate(self._teams):
            for _ in range(5):
                for robot, body in enumerate(bodies):
                    speed, rate = 0.5 * actions[world * ROBOTS + robot, 0], 2.0 * actions[world * ROBOTS + robot, 1]
                    body.velocity = (float(speed * math.cos(body.angle)), float(speed * math.sin(body.angle)))
                    body.angular_velocity = float(rate)
                space.step(0.04)
            for robot, body in enumerate(bodies):
                x, y = body.position
                others = pymunk.ShapeFilter(mask=pymunk.ShapeFilter.ALL_MASKS() ^ 1 << robot)
                for k in range(BEAMS):
                    angle = body.angle + k * 2 * math.pi / BEAMS
                    end = (x + 3.5 * math.cos(angle), y + 3.5 * math.sin(angle))
                    hit = space.segment_query_first((x, y), end, 0, others)
                    if hit is not None:
                        out[world * ROBOTS + robot, k] = hit.alpha
        return out


def wander(observations: NDArray[np.float32]) -> NDArray[np.float32]:
    """Drive along the way where the observation holds one, else straight on; slower before what is close ahead."""
    bearing = np.zeros(len(observations))
    if observations.shape[1] > BEAMS:
        bearing = np.arctan2(observations[:, -2], observations[:, -3])
    speed = 0.9 * (np.abs(bearing) < 0.7) * np.clip(6.0 * observations[:, 0], 0.0, 1.0)
    turn = np.where(observations[:, 0] < 0.15, 0.5, 1.5 * bearing)
    return np.stack([speed, np.clip(turn, -1.0, 1.0)], axis=1).astype(np.float32)


def rates(step: Callable[[NDArray[np.float32]], NDArray[np.float32]], robots: int, steps: int) -> tuple[float, float]:
    """Agent steps a second of wall-clock and of processor time, after a run-up in which ways are found and kept."""
    observations = np.ones((robots, BEAMS), np.float32)
    for _ in range(max(steps // 3, 2)):
        observations = step(wander(observations))
    begin, used = time.perf_counter(), time.process_time()
    for _ in range(steps):
        observations = step(wander(observations))
    return robots * steps / (time.perf_counter() - begin), robots * steps / (time.process_time() - used)


def main() -> None:
    """Print the table."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=600)
    given = parser.parse_args()
    naive = rates(NaiveTeams(load_floorplan("office"), 8).step, 8 * ROBOTS, max(given.steps // 20, 5))
    robots = TEAMS * ROBOTS
    team = {"robots": ROBOTS, "lidar": {"beams": BEAMS}}
    batch = gym.make_vec("lidarena/CorridorShared-v0", robots, "vector_entry_point", **team)
    batch.reset(seed=0)
    ours = rates(lambda actions: batch.step(actions)[0], robots, given.steps)
    print(f"{'':44} {'wall-clock':>12} {'processor':>12}")
    print(f"{'naive pymunk loop':44} {naive[0]:10,.0f}/s {naive[1]:10,.0f}/s")
    label = f"lidarena, {TEAMS} teams of {ROBOTS}, {BEAMS} beams (bar {BAR:,})"
    print(f"{label:44} {ours[0]:10,.0f}/s {ours[1]:10,.0f}/s  {ours[1] / naive[1]:.0f}× the naive loop")


if __name__ == "__main__":
    main()
