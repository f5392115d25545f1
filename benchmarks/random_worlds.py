"""What a world drawn afresh costs: resetting 64 worlds of 100 m², beside the same in a fixed maze, and beside driving.

python benchmarks/random_worlds.py [--rounds 3] [--slam truth rbpf]

Times are those of the processor, all threads together. The last column says how much longer an episode of 500 decisions
takes than in a plan that stays.
"""

import argparse
import time

import gymnasium as gym
import numpy as np

import lidarena  # noqa: F401
from lidarena.base.terminal import make_output_printable
from lidarena.world.random_plans import KINDS, MIXED

WORLDS, STEPS, EPISODE = 64, 30, 500
FIXED = "maze:7?width=10&height=10"


def costs(spec: str, slam: str, rounds: int) -> tuple[float, float]:
    """Processor time of resetting a world and of a decision in it [ms]."""
    batch = gym.make_vec("lidarena/Exploration-v0", WORLDS, "vector_entry_point", map=spec, slam=slam)
    actions = np.random.default_rng(0).integers(0, 3, (STEPS, WORLDS))
    batch.reset(seed=0)
    for row in actions:  # compiles, and lets the arrays grow to their size
        batch.step(row)
    resets, steps = [], []
    for number in range(1, rounds + 1):
        begin = time.process_time()
        batch.reset(seed=1000 * number)
        between = time.process_time()
        for row in actions:
            batch.step(row)
        steps.append((time.process_time() - between) / STEPS)
        resets.append(between - begin)
    return 1e3 * float(np.median(resets)) / WORLDS, 1e3 * float(np.median(steps)) / WORLDS


def main() -> None:
    """Print the table."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--slam", nargs="+", default=["truth", "rbpf"])
    options = parser.parse_args()
    for slam in options.slam:
        fixed, decision = costs(FIXED, slam, options.rounds)
        print(f"slam={slam!r}: a decision {decision:.3f} ms, a reset in a fixed maze {fixed:.2f} ms")
        for kind in [*KINDS, MIXED]:
            drawn, _ = costs(f"random:{kind}?area=100", slam, options.rounds)
            longer = (drawn - fixed) / (fixed + EPISODE * decision)
            print(f"  random:{kind:10} {drawn:6.2f} ms = {drawn / decision:5.0f} decisions {longer:+8.1%}", flush=True)


if __name__ == "__main__":
    main()
