"""The example of a family of one's own runs as it stands."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]


def test_the_example_is_measured_and_drawn(tmp_path: Path) -> None:
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-W", "error", str(ROOT / "examples" / "own_family.py")]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    random, straight = (float(line.split()[1]) for line in done.stdout.splitlines())
    assert random < 5 < 15 < straight
    pictures = tmp_path / "results" / "own_family" / "pictures"
    drawn = sorted(path.name for path in pictures.rglob("*.png"))
    assert drawn == ["overview.png", "own_family-Straight.png", "random.png"]
    assert "Buoys rounded ↑" in (pictures.parent / "table.md").read_text(encoding="utf-8")
