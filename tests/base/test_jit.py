"""Where compiled kernels are kept when neither the package nor the home can be written to."""

import os
import subprocess
import sys
from getpass import getuser
from pathlib import Path

import pytest

_PROGRAM = """
import os, warnings
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    from lidarena.base import jit

    @jit.kernel
    def doubled(x: float) -> float:
        return 2.0 * x

    @jit.leaf
    def tripled(x: float) -> float:
        return 3.0 * x

    print(doubled(1.5), tripled(1.5))
print(len(told), *(one.message for one in told))
print(os.environ.get("NUMBA_CACHE_DIR"))
"""


def run(temporary: Path, **more: str) -> list[str]:
    """Run the program where numba finds no place of its own: it may look into ``NUMBA_CACHE_DIR`` only."""
    script = temporary / "program.py"
    script.write_text(_PROGRAM)
    environment = os.environ | {
        "NUMBA_CACHE_LOCATOR_CLASSES": "UserProvidedCacheLocator",
        "TMPDIR": str(temporary),
        "PYTHONPATH": os.pathsep.join([os.getcwd(), *sys.path]),
    }
    environment.pop("NUMBA_CACHE_DIR", None)
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, timeout=300, env=environment | more, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_they_are_kept_in_a_temporary_folder_of_the_user(tmp_path: Path) -> None:
    values, told, folder = run(tmp_path)
    assert values == "3.0 4.5"
    assert told.startswith("1 compiled kernels can be kept neither beside the package nor in the home folder;")
    assert folder in told and told.endswith("Set NUMBA_CACHE_DIR to a folder that can be written to")
    assert folder == str(tmp_path / f"lidarena-kernels-{getuser()}")
    assert len(list(Path(folder).rglob("*.nbi"))) == 2
    assert Path(folder).stat().st_mode & 0o077 == 0
    kept = {path: path.stat().st_mtime_ns for path in Path(folder).rglob("*.nbc")}
    assert run(tmp_path)[0] == values
    assert {path: path.stat().st_mtime_ns for path in Path(folder).rglob("*.nbc")} == kept


@pytest.mark.parametrize("spoil", ["file", "everybody's"])
def test_where_that_is_not_to_be_had_they_are_compiled_anew(tmp_path: Path, spoil: str) -> None:
    folder = tmp_path / f"lidarena-kernels-{getuser()}"
    if spoil == "file":
        folder.touch()
    else:
        folder.mkdir()
        folder.chmod(0o777)
    values, told, named = run(tmp_path)
    assert values == "3.0 4.5" and named == "None"
    assert told.startswith("1 ") and "every process compiles them anew" in told and "Set NUMBA_CACHE_DIR" in told
    assert not list(tmp_path.rglob("*.nbi"))


def test_nothing_is_told_where_the_user_has_named_a_folder(tmp_path: Path) -> None:
    mine = tmp_path / "mine"
    assert run(tmp_path, NUMBA_CACHE_DIR=str(mine)) == ["3.0 4.5", "0", str(mine)]
    assert len(list(mine.rglob("*.nbi"))) == 2


def test_a_whole_environment_runs_from_there(tmp_path: Path) -> None:
    script = (
        "import lidarena, gymnasium as gym; print(gym.make('lidarena/Arena-v0', arena='yang').reset(seed=0)[0].shape)"
    )
    environment = os.environ | {"NUMBA_CACHE_LOCATOR_CLASSES": "UserProvidedCacheLocator", "TMPDIR": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", script], capture_output=True, text=True, timeout=500, env=environment
    )
    assert done.stdout.strip() == "(39,)", done.stderr
