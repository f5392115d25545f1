"""Exact resumption: trainings killed at random moments (kill -9) end with the weights of one that was left alone.

python benchmarks/kills.py [--kills 10] [--steps 24000] [--seed 0]
"""

import argparse
import csv
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_TRAINING = """
env: {{id: lidarena/Env1-v0, keywords: {{start: random, max_episode_steps: 200}}}}
total_steps: {steps}
num_envs: 8
checkpoint_every: 2000
normalize_reward: true
ppo: {{n_steps: 64, batch_size: 128, n_epochs: 4, learning_rate: {{start: 1e-3, end: 1e-4}}}}
"""


def begin(*arguments: str) -> subprocess.Popen[bytes]:
    """Start train.py in a process of its own."""
    command = [sys.executable, str(ROOT / "train.py"), *arguments]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def finish(*arguments: str) -> None:
    """Run train.py to its end."""
    if begin(*arguments).wait() != 0:
        raise RuntimeError(f"train.py {' '.join(arguments)} failed")


def kill_and_resume(config: Path, folder: Path, rows: int, wait: float) -> int:
    """Train, kill the training ``wait`` seconds after its curve has ``rows`` rows, and let it go on to the end.

    Returns:
        The step of the checkpoint from which it went on; 0 if there was none yet, -1 if it had ended before the kill.
    """
    training = begin("--config", str(config), "--out", str(folder))
    while _rows(folder) < rows and training.poll() is None:
        time.sleep(0.01)
    time.sleep(wait)
    was_running = training.poll() is None
    training.kill()
    training.wait()
    steps = [int(path.name.partition("_")[2]) for path in folder.glob("checkpoints/step_*")]
    finish("--resume", str(folder))
    return max(steps, default=0) if was_running else -1


def _rows(folder: Path) -> int:
    """Rows of the learning curve so far."""
    curve = folder / "progress.csv"
    return len(curve.read_text(encoding="utf-8").splitlines()) - 1 if curve.exists() else 0


def learned(folder: Path) -> tuple[bytes, bytes]:
    """All that a training has learned: the policy, and the last checkpoint's weights with Adam's moments."""
    last = max((folder / "checkpoints").iterdir())
    return (folder / "policy.safetensors").read_bytes(), (last / "model.safetensors").read_bytes()


def exact_resumptions(kills: int, steps: int, seed: int, root: Path) -> int:
    """Kill so many trainings, each at a random moment; how many ended with the weights of the one left alone."""
    config, alone = root / "training.yaml", root / "alone"
    config.write_text(_TRAINING.format(steps=steps), encoding="utf-8")
    finish("--config", str(config), "--out", str(alone))
    rows = _rows(alone)
    pace = _seconds(alone) / rows
    draw, exact, k, tries = random.Random(seed), 0, 0, 0
    while k < kills and tries < 3 * kills:
        folder, tries = root / f"killed_{tries}", tries + 1
        step = kill_and_resume(config, folder, draw.randrange(rows - 1), draw.uniform(0.0, pace))
        if step < 0 or step >= steps:
            continue  # it had come to its end: nothing was killed
        k, same = k + 1, learned(folder) == learned(alone)
        exact += same
        print(f"kill {k}: went on from step {step:6,}, {'the same weights' if same else 'OTHER WEIGHTS'}", flush=True)
    return exact


def _seconds(folder: Path) -> float:
    """How long a training took, without its start."""
    with (folder / "progress.csv").open(newline="", encoding="utf-8") as stream:
        return float(list(csv.DictReader(stream))[-1]["seconds"])


def main() -> None:
    """Print how many of the resumptions were exact."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--steps", type=int, default=24_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        exact = exact_resumptions(options.kills, options.steps, options.seed, Path(folder))
    print(f"{exact} of {options.kills} resumptions exact")
    sys.exit(exact != options.kills)


if __name__ == "__main__":
    main()
