"""PPO training, learning included, beside the naive environment's stepping alone.

python benchmarks/training.py [--config configs/train/quick.yaml] [--steps 400000]
"""

import argparse
import csv
import tempfile
from pathlib import Path

from environment import NaiveWorlds, rate

from lidarena import agents
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.terminal import make_output_printable
from lidarena.world.load import load_floorplan


def main() -> None:
    """Print both rates; the training's is that of the whole run, from its first step to its last checkpoint."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--config", default="configs/train/quick.yaml")
    parser.add_argument("--steps", type=int, default=400_000)
    options = parser.parse_args()
    naive = rate(NaiveWorlds(load_floorplan("env1"), 8).step, 8, 30)
    print(f"naive pymunk loop, 360 rays, no SLAM, no learning {naive:9,.0f} steps/s    1.0×", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        settings = [f"total_steps={options.steps}", f"out={folder}/run"]
        run = agents.train(agents.load_config(options.config, TrainingConfig, settings), progress=False)
        with (Path(run) / "progress.csv").open() as file:
            last = list(csv.DictReader(file))[-1]
    trained = int(last["step"]) / float(last["seconds"])
    print(
        f"PPO on Env-1, SLAM live, {int(last['step']):9,} steps         {trained:9,.0f} steps/s {trained / naive:6.1f}×"
    )


if __name__ == "__main__":
    main()
