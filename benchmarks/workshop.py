"""Decisions a second in the workshop: 64 worlds, a robot that takes anything allowed; and what ``stnu`` takes for one.

python benchmarks/workshop.py [--steps 300] [--tasks pile gearbox cabinet]

A second is one of the processor's (``time.process_time``) on one thread, so that other work on the machine does not
count; the second column is by the clock. Resets are included. ``cold`` and ``cached`` is the compilation of a task.
"""

import argparse
import os
import tempfile
import time
from pathlib import Path

import numpy as np

import lidarena
from lidarena.base.terminal import make_output_printable
from lidarena.envs import BatchedWorkshop, WorkshopEnv, set_num_threads
from lidarena.envs.workshop.compiler import compile_task
from lidarena.envs.workshop.task import load_task

WORLDS = 64


def decisions_a_second(task: str, steps: int) -> tuple[float, float]:
    """By the processor's time, and by the clock."""
    env = BatchedWorkshop(WORLDS, task=task, human="mixture")
    env.reset(seed=0)
    rng = np.random.default_rng(0)
    for k in range(steps + 20):
        if k == 20:  # warm
            clock, processor = time.perf_counter(), time.process_time()
        masks = env.action_masks()
        env.step((rng.random(masks.shape) * masks).argmax(axis=1))
    count = WORLDS * steps
    return count / (time.process_time() - processor), count / (time.perf_counter() - clock)


def decision_times(task: str, episodes: int = 10) -> np.ndarray:
    """Of ``stnu``, without the first episode, which compiles [ms]."""
    env = WorkshopEnv(task=task, human="mixture")
    policy, times = lidarena.baselines.make("stnu", env), []
    for seed in range(episodes):
        observation, info = env.reset(seed=seed)
        policy.reset(seed=seed)
        over = False
        while not over:
            begin = time.process_time()
            action = policy.act(observation, info)
            if seed:
                times.append(1000.0 * (time.process_time() - begin))
            observation, _, terminated, truncated, info = env.step(action)
            over = terminated or truncated
    return np.array(times)


def compilation(task: str) -> tuple[float, float]:
    """Processor time to compile a task and to read it again [s]."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["LIDARENA_CACHE"] = str(Path(folder))
        begin = time.process_time()
        compile_task(load_task(task))
        between = time.process_time()
        compile_task(load_task(task))
        del os.environ["LIDARENA_CACHE"]
        return between - begin, time.process_time() - between


def main() -> None:
    """Print a line a task."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=300)
    parser.add_argument("--tasks", nargs="+", default=["pile", "gearbox", "cabinet"])
    given = parser.parse_args()
    make_output_printable()
    set_num_threads(1)
    print("task      decisions/CPU s   by the clock   stnu mean ms   99% ms   cold s   cached s")
    for task in given.tasks:
        cold, cached = compilation(task)
        fast, clock = decisions_a_second(task, given.steps)
        times = decision_times(task)
        late = np.quantile(times, 0.99)
        print(f"{task:8} {fast:16,.0f} {clock:14,.0f} {times.mean():14.2f} {late:8.2f} {cold:8.2f} {cached:10.2f}")


if __name__ == "__main__":
    main()
