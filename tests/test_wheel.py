"""The wheel is whole: built, installed beside the checkout, the main job runs from an empty folder."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

pytest.importorskip("build", reason="needs build, which the lock file installs")
ROOT = Path(__file__).parent.parent
TRAIN = ["total_steps=32", "num_envs=2", "checkpoint_every=32", "ppo.n_steps=8", "ppo.batch_size=16", "ppo.n_epochs=1"]
EVALUATE = ["episodes=1", "keywords.max_episode_steps=30", "workers=1"]


def run(*command: str | Path, cwd: Path, **variables: str) -> str:
    done = subprocess.run(
        [str(part) for part in command], cwd=cwd, env=os.environ | variables, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built from what a fresh clone would hold."""
    source = tmp_path_factory.mktemp("source") / "lidarena"
    skip = shutil.ignore_patterns("__pycache__", "*.nb[ci]", "*.egg-info")
    shutil.copytree(ROOT / "lidarena", source / "lidarena", ignore=skip)
    shutil.copytree(ROOT / "configs", source / "configs", ignore=skip)
    for name in ("pyproject.toml", "setup.py", "MANIFEST.in", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    out = tmp_path_factory.mktemp("wheel")
    run(sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", out, source, cwd=out)
    (file,) = out.glob("*.whl")
    return file


@pytest.fixture(scope="module")
def site(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel installed into a folder; with the checkout's compiled kernels, which would take a minute again."""
    folder = tmp_path_factory.mktemp("site")
    pip = [sys.executable, "-m", "pip", "install", "--no-deps", "--no-index", "--quiet", "--target"]
    run(*pip, folder, wheel, cwd=folder)
    for path in (ROOT / "lidarena").rglob("*.py"):  # numba goes by a source's time and size
        installed = folder / path.relative_to(ROOT)
        os.utime(installed, ns=(path.stat().st_atime_ns, path.stat().st_mtime_ns))
    for path in (ROOT / "lidarena").rglob("__pycache__/*.nb[ci]"):
        installed = folder / path.relative_to(ROOT)
        installed.parent.mkdir(exist_ok=True)
        shutil.copy2(path, installed)
    return folder


def test_it_is_small_and_holds_what_the_package_reads(wheel: Path) -> None:
    assert wheel.stat().st_size <= 10e6
    held = set(zipfile.ZipFile(wheel).namelist())
    for path in (ROOT / "lidarena").rglob("*"):
        if path.is_file() and "__pycache__" not in path.parts:
            assert str(path.relative_to(ROOT)) in held
    for path in (ROOT / "configs").rglob("*.yaml"):
        assert f"lidarena/{path.relative_to(ROOT)}" in held
    assert not [name for name in held if name.startswith(("tests/", "benchmarks/", "examples/"))]


def test_the_main_job_runs_from_an_empty_folder(site: Path, tmp_path: Path) -> None:
    where = {"PYTHONPATH": str(site)}
    program = site / "bin" / "lidarena"
    code = "import lidarena; print(lidarena.__file__)"
    assert run(sys.executable, "-c", code, cwd=tmp_path, **where).startswith(str(site))
    assert "runs/quick" in run(program, "train", "quick", "--set", *TRAIN, cwd=tmp_path, **where)
    assert "tables:" in run(program, "evaluate", "quick", "--set", *EVALUATE, cwd=tmp_path, **where)
    assert (tmp_path / "results" / "quick" / "results.json").is_file()
    assert "train quick" in run(program, "list", "configs", "--names", cwd=tmp_path, **where)
