"""Ray Tune over the keys of a training file: every trial is ``lidarena train --set …``. Needs: pip install "ray[tune]".

python examples/ray_tune.py
"""

import csv

from ray import tune

from lidarena import agents
from lidarena.base.yaml_config import check_config

CONFIG = {"env": {"id": "lidarena/Arena-v0"}, "total_steps": 8192, "num_envs": 16, "checkpoint_every": 8192}
SPACE = {"ppo.learning_rate": tune.loguniform(1e-4, 3e-3), "ppo.n_steps": tune.choice([64, 128])}


def trial(keys):
    """Train with some keys changed, and report the mean return of the last update."""
    changes = [f"{key}={value}" for key, value in keys.items()]
    config = check_config(CONFIG, agents.TrainingConfig, [*changes, "out=run"])
    folder = agents.train(config, progress=False)
    with open(folder / "progress.csv") as curve:
        last = list(csv.DictReader(curve))[-1]
    tune.report({"return": float(last["episode_return"])})


if __name__ == "__main__":
    tuner = tune.Tuner(
        trial, param_space=SPACE, tune_config=tune.TuneConfig(num_samples=3, metric="return", mode="max")
    )
    best = tuner.fit().get_best_result()
    print(f"best return {best.metrics['return']:.1f} with {best.config}")
