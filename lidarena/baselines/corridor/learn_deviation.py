"""Learn how far robots deviate from their plans, as Bennewitz & Burgard do (section 2), and draw it like their Fig. 2.

    python -m lidarena.baselines.corridor.learn_deviation [--runs 28] [--seed 0] [--out FILE] [--picture FILE]

Two robots execute plans in the office, by the clock and with the simulator's motion noise. At every moment the point of
its path to which the one robot is closest tells what time it is by the plan; the other robot's distance from where it
should be at that time is recorded.
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import LidarenaError
from lidarena.base.files import check_writable, write_figure
from lidarena.base.terminal import make_output_printable
from lidarena.baselines.corridor.deviation_model import BIN, MODEL_FILE, DeviationModel
from lidarena.baselines.corridor.team_planners import PrioritizedFleet
from lidarena.envs.corridor.parallel_env import CorridorEnv

RUNS = 28
"""Bennewitz & Burgard's number of experiments."""
RADIUS = 0.2
"""Of the robots that the model is learned with, about the size of Bennewitz & Burgard's [m]."""
_PARTS = 10  # of a step, to which the time by the plan is found


def record_runs(runs: int = RUNS, seed: int = 0, **keywords: Any) -> NDArray[np.float64]:
    """Record the deviations (n,) [m] of two-robot executions.

    Args:
        runs: Executions.
        seed: Of the first one; the others follow.
        **keywords: Of the environment.
    """
    keywords = {"robot": {"radius": RADIUS}} | keywords | {"robots": 2, "collision_ends": False, "expose_truth": True}
    env = CorridorEnv(**keywords)
    policy = PrioritizedFleet(env, deviation=False, planning_radius=env.options.robot.radius)
    return np.concatenate([np.fromiter(_deviations(env, policy, seed + run), float) for run in range(runs)])


def _deviations(env: CorridorEnv, policy: PrioritizedFleet, seed: int) -> Iterator[float]:
    observations, infos = env.reset(seed=seed)
    policy.reset(seed)
    actions = policy.act(observations, infos)
    if policy.finished:
        return
    driving = policy.driving
    times = np.arange(0, max(len(curve) for curve in driving.curves) * _PARTS) * (driving.step / _PARTS)
    planned = np.array([[driving.planned(robot, float(time)) for time in times] for robot in range(2)])
    while len(env.agents) == 2:  # both on their way
        observations, _, _, _, infos = env.step(actions)
        positions = next(iter(infos.values()))["truth"]["pose"][:, :2]
        away = ((planned - positions[:, None]) ** 2).sum(axis=2)
        for one, other in ((0, 1), (1, 0)):
            by_plan = int(np.argmin(away[one]))  # the closest point of the one's path says what time it is
            yield float(np.sqrt(away[other, by_plan]))
        actions = policy.act(observations, infos)


def draw_model(model: DeviationModel, path: Path) -> None:
    """Draw the recorded frequencies and the fitted linear pieces, as in Bennewitz & Burgard's Fig. 2."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 3.6), dpi=120, layout="constrained")
    axes = figure.add_subplot()
    share = model.counts / model.counts.sum()
    axes.bar((np.arange(len(share)) + 0.5) * BIN, share, BIN * 0.9, color="#9DB7D5", label="recorded")
    axes.plot(model.knots[:, 0], model.knots[:, 1] * BIN, "o-", color="#D55E00", label="linear pieces")
    axes.set_xlabel("distance from the planned position (m)")
    axes.set_ylabel(f"probability (ranges of {BIN:g} m)")
    axes.set_title(f"Deviation of a robot from its plan, {model.runs} runs of two robots")
    axes.legend(frameon=False)
    write_figure(path, figure)


def main(arguments: list[str] | None = None) -> int:
    """Learn, store and draw the model; return 0, or 2 for a refusal."""
    make_output_printable()
    parser = argparse.ArgumentParser(description="Learn how far robots deviate from their plans.")
    parser.add_argument(
        "--runs", type=int, default=RUNS, help="two-robot executions; Bennewitz & Burgard's 28 by default"
    )
    parser.add_argument("--seed", type=int, default=0, help="of the first run")
    parser.add_argument("--out", type=Path, default=MODEL_FILE, help="where the model is stored")
    parser.add_argument(
        "--picture", type=Path, default=Path("results/deviation.png"), help="like Bennewitz & Burgard's Fig. 2"
    )
    given = parser.parse_args(arguments)
    try:
        _learn(given.runs, given.seed, given.out, given.picture)
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    return 0


def _learn(runs: int, seed: int, out: Path, picture: Path) -> None:
    for path in (out, picture):
        check_writable(path)
    distances = record_runs(runs, seed)
    model = DeviationModel.fitted(distances, runs)
    model.save(out)
    draw_model(model, picture)
    mean, tail = distances.mean(), np.quantile(distances, 0.95)
    print(f"{runs} runs, {len(distances)} distances: mean {mean:.2f} m, 95% below {tail:.2f} m")
    print(f"model:   {out}\npicture: {picture}")


if __name__ == "__main__":
    sys.exit(main())
