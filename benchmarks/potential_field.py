"""Yang et al.'s potential fields against the bars: Figs. 2, 4 and 8, U traps, random arenas, BARN, time of a plan.

python benchmarks/potential_field.py [--barn FILE.npz] [--traps 300] [--arenas 300]
"""

import argparse
import itertools
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.potential_field.circle_grid import astar_path
from lidarena.planning.potential_field.guided_field import plan_guided_path
from lidarena.planning.potential_field.potential_field import PathResult, PotentialField, plan_path
from lidarena.world.arenas import Arena, load_arena
from lidarena.world.barn import barn_indices, load_barn
from lidarena.world.random_arenas import DENSITIES

Planner = Callable[[Arena], PathResult]
ROBOT_SPEED = 1.0
"""At which BARN's time is counted (m/s); its optimal time is the reference path's at 2 m/s."""


class Plan(NamedTuple):
    """What is counted of a plan."""

    success: bool
    collided: bool
    ratio: float
    raw_ratio: float
    clearance: float
    fills: int
    milliseconds: float
    length: float


def path_length(path: NDArray[np.float64]) -> float:
    """Length of a polyline (M, 2)."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def clearance(path: NDArray[np.float64], arena: Arena, samples_per_metre: float) -> float:
    """Least distance of densely sampled points to a surface, by plain numpy: an independent validator."""
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    wanted = np.union1d(at, np.linspace(0.0, at[-1], int(at[-1] * samples_per_metre) + 2))
    points = np.column_stack([np.interp(wanted, at, path[:, axis]) for axis in (0, 1)])
    low, high = np.array(arena.bounds[:2]), np.array(arena.bounds[2:])
    least = min(float((points - low).min()), float((high - points).min()))
    for x, y, radius in arena.circles.tolist():
        least = min(least, float(np.hypot(points[:, 0] - x, points[:, 1] - y).min()) - radius)
    return least - arena.robot_radius


def field_planner(preset: str) -> Planner:
    """The planner with a preset."""
    return lambda a: plan_path(a.circles, a.start, a.goal, preset, a.robot_radius, a.bounds)


def guided(arena: Arena) -> PathResult:
    """The field that A* leads; its smooth path is what counts."""
    found = plan_guided_path(arena.circles, arena.start, arena.goal, arena.robot_radius, arena.bounds)
    return found._replace(smoothed=found.path)


def measure(arena: Arena, planner: Planner) -> Plan:
    """Plan once, and look whether the path is free."""
    begin = time.process_time()
    result = planner(arena)
    spent = 1e3 * (time.process_time() - begin)
    straight = math.dist(arena.start, arena.goal)
    side = max(arena.bounds[2] - arena.bounds[0], arena.bounds[3] - arena.bounds[1])
    paths = (result.smoothed, result.path) if result.success else ()  # a lost walk is long, and counts for nothing
    gaps = [clearance(path, arena, 5000.0 / side) for path in paths]
    length = path_length(result.smoothed)
    touched = result.collided or min(gaps, default=0.0) < 0.0
    free = result.success and not touched
    return Plan(
        free,
        touched,
        length / straight,
        path_length(result.path) / straight,
        min(gaps, default=0.0),
        result.fills,
        spent,
        length,
    )


def report(name: str, arenas: Sequence[Arena], planner: Planner) -> list[Plan]:
    """Print a row of the table."""
    planner(arenas[0])
    plans = [measure(arena, planner) for arena in arenas]
    good = [plan for plan in plans if plan.success]
    row = f"{name:26} {len(plans):5} {100 * len(good) / len(plans):8.2f}% {sum(p.collided for p in plans):5}"
    if good:
        ratios = [p.ratio for p in good]
        row += f" {np.mean(ratios):7.3f} {max(ratios):7.3f} {np.mean([p.raw_ratio for p in good]):7.3f}"
        row += f" {min(p.clearance for p in good):9.4f} {np.mean([p.fills for p in good]):6.1f}"
    else:
        row += " " * 7 * 7
    print(f"{row:100} {np.median([p.milliseconds for p in plans]):8.2f}", flush=True)
    return plans


def figures() -> None:
    """Print what Figs. 2 and 4 show, and the error of the forces."""
    scene = ([[0.5, 0.0, 0.0]], (-4.0, 0.0), (0.0, 0.0))
    x = np.linspace(-1.0, 0.45, 1_450_001)
    line = np.column_stack([x, np.zeros_like(x)])
    for preset in ("traditional", "paper"):
        force = PotentialField.of(*scene, preset, rho_0=1.5).force(line)[:, 0]
        zeros = x[1:][(force[:-1] > 0) & (force[1:] <= 0)]
        print(f"Fig. 2, {preset:11}: minima at x = {', '.join(f'{z:.3f}' for z in zeros)}")
    circles = np.array([(29, 45, 0), (40, 45, 0), (65, 45, 0), (74, 74, 0)], dtype=np.float64)
    field = PotentialField.of(circles, (0, 0), (70, 70), "paper")
    side = np.arange(0.0, 100.01, 0.5)
    potential = field.potential(np.stack(np.meshgrid(side, side), axis=-1))
    inner = potential[1:-1, 1:-1]
    lowest = np.ones(inner.shape, np.bool_)
    for r, c in itertools.product(range(3), range(3)):
        if (r, c) != (1, 1):
            lowest &= inner < potential[r : r + inner.shape[0], c : c + inner.shape[1]]
    minima = [(float(side[c + 1]), float(side[r + 1])) for r, c in np.argwhere(lowest)]
    print(f"Fig. 4, paper      : minima on a grid of 0.5 m: {minima}")
    for preset in ("traditional", "paper", "robust"):
        print(f"forces, {preset:11}: -grad U by finite differences to {worst_force(preset):.1e} of the force")


def worst_force(preset: str) -> float:
    """Largest relative difference of the force to central differences of the potential, at 10,000 points."""
    arena = load_arena("yang:u")
    field = PotentialField.of(arena.circles, arena.start, arena.goal, preset, 0.0, arena.bounds)
    points = np.random.default_rng(0).uniform(-4.0, 94.0, (10_000, 2))
    away = np.hypot(points[:, None, 0] - arena.circles[:, 0], points[:, None, 1] - arena.circles[:, 1])
    goal = np.hypot(*(points - np.array(arena.goal)).T)
    points = points[(away.min(axis=1) > 1.3) & (np.abs(goal - 8.0) > 0.01)]
    step, numeric = 1e-4, np.empty_like(points)
    for axis, shift in enumerate(np.eye(2) * step):
        u = [field.potential(points + c * shift) for c in (-2, -1, 1, 2)]
        numeric[:, axis] = -(u[0] - 8 * u[1] + 8 * u[2] - u[3]) / (12 * step)
    force = field.force(points)
    return float((np.hypot(*(force - numeric).T) / (1.0 + np.hypot(*force.T))).max())


def barn(path: str) -> None:
    """Print the BARN rows, and their scores."""
    arenas = [load_arena(f"barn:{index}", path=path) for index in barn_indices(path)]
    optimal = [path_length(load_barn(index, path).reference) / 2.0 for index in barn_indices(path)]
    planners = {"traditional": field_planner("traditional"), "paper": field_planner("paper")}
    planners |= {"robust": field_planner("robust"), "guided": guided}
    for name, planner in planners.items():
        plans = report(f"barn {name}", arenas, planner)
        times = [plan.length / ROBOT_SPEED for plan in plans]
        scores = [p.success * o / min(max(t, 2 * o), 8 * o) for p, o, t in zip(plans, optimal, times, strict=True)]
        print(f"{'':26} BARN score {np.mean(scores):.3f} at {ROBOT_SPEED:g} m/s, world known, disc of 0.215 m")


def plan_time() -> float:
    """Median milliseconds of a robust plan on ``yang:u``, of 200."""
    arena = load_arena("yang:u")
    planner = field_planner("robust")
    planner(arena)
    spent = []
    for _ in range(200):
        begin = time.perf_counter()
        planner(arena)
        spent.append(time.perf_counter() - begin)
    return 1e3 * float(np.median(spent))


def main() -> None:
    """Print the figures and the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--barn", help="the BARN worlds (.npz)")
    parser.add_argument("--traps", type=int, default=300, help="U traps")
    parser.add_argument("--arenas", type=int, default=300, help="random arenas of each density")
    args = parser.parse_args()
    figures()
    head = f"{'arenas, planner':26} {'plans':>5} {'success':>9} {'hits':>5} {'length':>7} {'worst':>7} {'walked':>7}"
    print(f"{head} {'clearance':>9} {'fills':>6} {'ms':>14}  (length: over the straight line, after regression search)")
    starts = np.random.default_rng(0).uniform(-2.0, 2.0, (20, 2)).tolist()
    for name, preset in itertools.product(("yang", "yang:arc", "yang:u"), ("traditional", "paper", "robust")):
        arena = load_arena(name)
        report(f"{name} {preset}", [replace(arena, start=(x, y)) for x, y in starts], field_planner(preset))
    traps = [load_arena(f"u_trap:{seed}") for seed in range(args.traps)]
    for preset in ("traditional", "paper", "robust"):
        report(f"u_trap {preset}", traps, field_planner(preset))
    report("u_trap guided", traps, guided)
    for density in DENSITIES:
        drawn = [load_arena(f"random:{seed}", density=density) for seed in range(args.arenas)]
        open_ = [a for a in drawn if len(astar_path(a.circles, a.start, a.goal, a.robot_radius, a.bounds))]
        print(f"random, density {density:g}: A* finds a path in {len(open_)} of {len(drawn)}")
        for preset in ("traditional", "paper", "robust"):
            report(f"random {density:g} {preset}", open_, field_planner(preset))
        report(f"random {density:g} guided", open_, guided)
    if args.barn:
        barn(args.barn)
    print(f"a robust plan on yang:u takes {plan_time():.2f} ms (median of 200, warm kernels, one core)")


if __name__ == "__main__":
    main()
