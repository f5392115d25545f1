"""Memory of 64 worlds with live SLAM in Env-3, and whether it grows.

python benchmarks/memory.py [--steps 1000000]
"""

import argparse
from pathlib import Path

import gymnasium as gym
import numpy as np

import lidarena  # noqa: F401

WORLDS = 64


def resident() -> float:
    """Resident memory of this process [MiB] (Linux)."""
    fields = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines())
    return int(fields["VmRSS"].split()[0]) / 1024


def main() -> None:
    """Print the resident memory ten times along the way."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=1_000_000, help="of all worlds together")
    steps = parser.parse_args().steps // WORLDS
    before = resident()
    batch = gym.make_vec("lidarena/Env3-v0", WORLDS, "vector_entry_point")
    batch.reset(seed=0)
    rng = np.random.default_rng(0)
    print(f"imports alone {before:.0f} MiB")
    for part in range(10):
        for _ in range(steps // 10):
            batch.step(rng.choice(3, size=WORLDS, p=[0.6, 0.2, 0.2]))
        print(f"after {(part + 1) * steps // 10 * WORLDS:10,} steps: {resident():7.0f} MiB", flush=True)


if __name__ == "__main__":
    main()
