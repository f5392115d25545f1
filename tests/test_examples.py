"""The programs in examples/ run, print what they promise, and are short."""

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
PROMISED = {
    "cleanrl_ppo": r"65536 steps, \d+ episodes, mean return (-[0-9]\.|[0-9])",
    "own_environment": r"the trained agent needs 10 steps",
    "own_family": r"Straight: \d\d",
    "own_lidar": r"exploration: [6-9]\d%.*False\narena: .* True\ncorridor: .*683 beams",
    "own_map": r"hall 2 with \d pillars: [5-9]\d% mapped",
    "own_policy": r"room seeker: [3-9]\d% of Env-1 mapped",
    "own_slam": r"frontier explored ([4-9]\d|100)%",
    "ray_tune": r"best return",
    "rllib_ppo": r"iteration 2: .* return",
    "torchrl_ppo": r"mean return .*\na team's rewards",
}
OTHER_LIBRARIES = {"ray_tune": "tensorboardX", "rllib_ppo": "ormsgpack", "torchrl_ppo": "torchrl"}
"""What examples need beside what the package itself needs; tried by hand where it is not installed."""
MOST_LINES = {"own_family": 60}
"""A family is an environment, its measures and its picture."""


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs(path: Path, tmp_path: Path) -> None:
    needed = OTHER_LIBRARIES.get(path.stem)
    if needed is not None and importlib.util.find_spec(needed) is None:
        pytest.skip(f"needs {needed}, which the tests do not install")
    done = subprocess.run(
        [sys.executable, path],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert done.returncode == 0, done.stderr
    assert re.search(PROMISED.get(path.stem, "."), done.stdout), done.stdout


@pytest.mark.parametrize(
    "path", [path for path in EXAMPLES if path.stem.startswith("own_")], ids=lambda path: path.stem
)
def test_what_a_stranger_writes_is_short(path: Path) -> None:
    """All lines count: docstrings, imports, blank ones and the demonstration."""
    assert len(path.read_text().splitlines()) <= MOST_LINES.get(path.stem, 40)


def test_the_pages_name_every_example() -> None:
    texts = "".join(page.read_text() for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")])
    assert [name for name in PROMISED if f"examples/{name}.py" not in texts] == []
