"""Exact resumption: trainings killed at random moments (kill -9) end with the weights of one that was left alone.

python benchmarks/kills.py [--kills 10] [--steps 24000] [--seed 0]
"""

import argparse
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


def kill_and_resume(config: Path, folder: Path, wait: float) -> int:
    """Train, kill the training ``wait`` seconds after its folder has appeared, and let it go on to the end.

    Returns:
        The step of the checkpoint from which it went on; 0 if there was none yet.
    """
    training = begin("--config", str(config), "--out", str(folder))
    while not (folder / "config.yaml").exists():
        time.sleep(0.01)
    time.sleep(wait)
    training.kill()
    training.wait()
    steps = [int(path.name.partition("_")[2]) for path in folder.glob("checkpoints/step_*")]
    finish("--resume", str(folder))
    return max(steps, default=0)


def learned(folder: Path) -> tuple[bytes, bytes]:
    """All that a training has learned: the policy, and the last checkpoint's weights with Adam's moments."""
    last = max((folder / "checkpoints").iterdir())
    return (folder / "policy.safetensors").read_bytes(), (last / "model.safetensors").read_bytes()


def exact_resumptions(kills: int, steps: int, seed: int, root: Path) -> int:
    """Kill so many trainings, each at a random moment; how many ended with the weights of the one left alone."""
    config, alone = root / "training.yaml", root / "alone"
    config.write_text(_TRAINING.format(steps=steps), encoding="utf-8")
    began = time.perf_counter()
    finish("--config", str(config), "--out", str(alone))
    length = time.perf_counter() - began
    draw, exact = random.Random(seed), 0
    for k in range(kills):
        step = kill_and_resume(config, root / f"killed_{k}", draw.uniform(0.0, 0.7 * length))
        same = learned(root / f"killed_{k}") == learned(alone)
        exact += same
        print(
            f"kill {k + 1}: went on from step {step:6,}, {'the same weights' if same else 'OTHER WEIGHTS'}", flush=True
        )
    return exact


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
