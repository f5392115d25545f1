"""The house as it stands: imports run downwards only, files and functions can be held in the head."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "lidarena"
FLOORS = {"base": 0, "world": 1, "slam": 2, "planning": 2, "temporal": 2, "vision": 2, "envs": 3, "baselines": 4}
FLOORS |= {"agents": 5, "evaluation": 6, "cli": 7}
SOURCES = sorted(PACKAGE.rglob("*.py"))


def rooms_imported(path: Path) -> set[str]:
    rooms = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("lidarena."):
            rooms.add(node.module.split(".")[1])
        if isinstance(node, ast.Import):
            rooms |= {alias.name.split(".")[1] for alias in node.names if alias.name.startswith("lidarena.")}
    return rooms


@pytest.mark.parametrize("path", [p for p in SOURCES if p.parent != PACKAGE], ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_run_downwards_only(path: Path) -> None:
    own = path.relative_to(PACKAGE).parts[0]
    for room in rooms_imported(path) - {own}:
        assert FLOORS[room] < FLOORS[own], f"{own} imports {room}"


def test_every_room_of_the_package_has_a_floor() -> None:
    rooms = {p.name for p in PACKAGE.iterdir() if p.is_dir() and (p / "__init__.py").exists()}
    assert rooms <= set(FLOORS)


def test_importing_the_package_loads_neither_torch_nor_matplotlib() -> None:
    import subprocess
    import sys

    code = "import sys, lidarena; print(sorted({'torch', 'stable_baselines3', 'matplotlib'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_files_and_functions_can_be_held_in_the_head() -> None:
    for path in SOURCES:
        text = path.read_text()
        assert text.count("\n") <= 500, path
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                assert (node.end_lineno or 0) - node.lineno < 75, f"{path}: {node.name}"


def test_no_room_is_named_after_nothing() -> None:
    assert not {p.stem for p in SOURCES} & {"utils", "util", "helpers", "helper", "common", "misc", "tools"}


def test_kernels_are_compiled_in_one_way() -> None:
    """So that where their cache goes is decided in one place."""
    assert [p for p in SOURCES if "njit" in p.read_text()] == [PACKAGE / "base" / "jit.py"]
