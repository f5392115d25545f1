"""The notebooks of examples/ run from the first cell to the last, as plain Python in a folder of their own."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))


def cells(path: Path, kind: str) -> list[dict[str, object]]:
    return [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == kind]


def source(cell: dict[str, object]) -> str:
    lines = cell["source"]
    assert isinstance(lines, list)
    return "".join(lines)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, tmp_path: Path) -> None:
    (tmp_path / "cells.py").write_text("\n\n".join(map(source, cells(path, "code"))))
    command = [sys.executable, "-W", "ignore::UserWarning", "cells.py"]  # Agg shows no windows
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg", "TMPDIR": str(tmp_path)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_shows_what_its_cells_gave(path: Path) -> None:
    """Whoever reads it on a page sees the outputs, pictures among them, and no error."""
    outputs = [output for cell in cells(path, "code") for output in cell["outputs"]]  # type: ignore[attr-defined]
    assert not [output for output in outputs if output["output_type"] == "error"]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert path.stat().st_size < 700_000


def test_there_are_five_and_a_page_names_them() -> None:
    page = (ROOT / "docs" / "getting-started.md").read_text()
    assert len(NOTEBOOKS) == 5 and [path.name for path in NOTEBOOKS if path.name not in page] == []
