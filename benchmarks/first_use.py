"""How long a newcomer waits: nothing compiled yet, and the second time; and whether both compute the same to the bit.

python benchmarks/first_use.py
"""

import os
import subprocess
import sys
import tempfile
import time

CODE = """
import gymnasium as gym, hashlib, lidarena
env = gym.make('lidarena/Env1-v0')
env.reset(seed=0)
digest = hashlib.sha256()
for _ in range(12):
    observation, *_, info = env.step(0)
    digest.update(observation.tobytes() + info["pose"].tobytes() + info["map"].tobytes())
print(digest.hexdigest()[:16])
"""


def use(cache: str) -> tuple[float, str]:
    """Wall-clock time and digest of a fresh interpreter that runs ``CODE`` with its own cache of compiled kernels."""
    begin = time.perf_counter()
    environment = os.environ | {"NUMBA_CACHE_DIR": cache}
    done = subprocess.run([sys.executable, "-c", CODE], check=True, env=environment, stdout=subprocess.PIPE, text=True)
    return time.perf_counter() - begin, done.stdout.strip()


def main() -> None:
    """Print both times."""
    with tempfile.TemporaryDirectory() as cache:
        first, digest = use(cache)
        later = [use(cache) for _ in range(3)]
    print(f"first use after installation: {first:5.1f} s")
    print(f"later:                        {min(time for time, _ in later):5.1f} s")
    print(f"same bits compiled as loaded: {all(other == digest for _, other in later)}")


if __name__ == "__main__":
    main()
