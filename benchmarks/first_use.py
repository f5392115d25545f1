"""How long a newcomer waits: ``gym.make`` + ``reset`` + ``step`` with nothing compiled yet, and the second time.

python benchmarks/first_use.py
"""

import os
import subprocess
import sys
import tempfile
import time

CODE = (
    "import gymnasium as gym, lidarena; env = gym.make('lidarena/Env1-v0'); env.reset(seed=0); env.step(0)"
)


def seconds(cache: str) -> float:
    """Wall-clock time of a fresh interpreter that runs ``CODE`` with its own cache of compiled kernels."""
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-c", CODE], check=True, env=os.environ | {"NUMBA_CACHE_DIR": cache})
    return time.perf_counter() - begin


def main() -> None:
    """Print both times."""
    with tempfile.TemporaryDirectory() as cache:
        print(f"first use after installation: {seconds(cache):5.1f} s")
        print(f"later:                        {min(seconds(cache) for _ in range(3)):5.1f} s")


if __name__ == "__main__":
    main()
