"""Baselines that installed packages tell of."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
MODULE = """
from lidarena.baselines import register

class Left:
    family = "arena"

    def __init__(self, env, *, sharply=False):
        self.action = env.action_space.high if sharply else env.action_space.high / 2

    def reset(self, seed=None):
        pass

    def act(self, observation, info):
        return self.action
"""
REGISTERING = """
from lidarena.baselines import register
from stranger_policies import Left

register("stranger_right")(type("Right", (Left,), {}))
"""
POINTS = """
[lidarena.baselines]
stranger_left = stranger_policies:Left
stranger_module = stranger_registering
stranger_gone = stranger_policies:Gone
frontier = stranger_policies:Left
"""


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """Of a process in which a package of somebody else is installed."""
    about = tmp_path / "stranger-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: stranger\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(POINTS)
    (tmp_path / "stranger_policies.py").write_text(MODULE)
    (tmp_path / "stranger_registering.py").write_text(REGISTERING)
    return os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), str(tmp_path)])}


def run(environment: dict[str, str], *command: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([sys.executable, *command], env=environment, cwd=ROOT, capture_output=True, text=True)


def test_they_are_made_by_name_and_what_cannot_be_loaded_is_told(environment: dict[str, str]) -> None:
    code = """
import warnings
import gymnasium as gym
from lidarena import baselines
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    print(sorted(name for name in baselines.names() if name.startswith("stranger")))
print(*sorted(str(one.message) for one in told), sep="\\n")
arena, maze = gym.make("lidarena/Arena-v0", arena="yang"), gym.make("lidarena/Env1-v0")
sharp, frontier = baselines.make("stranger_left", arena, sharply=True), baselines.make("frontier", maze)
print(sharp.act(None, {}), type(frontier).__name__)
for env, options in ((arena, {"sharpl": True}), (maze, {})):
    try:
        baselines.make("stranger_left", env, **options)
    except ValueError as refusal:
        print(refusal)
"""
    done = run(environment, "-c", code)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0] == "['stranger_left', 'stranger_right']"
    assert lines[1].startswith("stranger declares a baseline 'frontier', which is left out: ")
    assert lines[2].startswith("stranger declares a baseline 'stranger_gone', which is left out: ")
    assert lines[3] == "[1.] FrontierPolicy"
    assert "no option 'sharpl'; did you mean 'sharply'" in lines[4]
    assert "'stranger_left' drives arena environments only" in lines[5]


def test_they_are_compared_from_a_file(environment: dict[str, str], tmp_path: Path) -> None:
    policies = ["stranger_left", {"name": "stranger_policies:Left", "label": "by module", "options": {"sharply": True}}]
    envs = [{"id": "lidarena/Arena-v0", "keywords": {"arena": "yang"}}]
    content = {"envs": envs, "policies": policies, "episodes": 1, "workers": 2, "out": str(tmp_path / "out")}
    (tmp_path / "compare.yaml").write_text(yaml.safe_dump(content | {"pictures": False}))
    done = run(environment, "-W", "ignore::RuntimeWarning", "evaluate.py", "--config", str(tmp_path / "compare.yaml"))
    assert done.returncode == 0, done.stderr
    assert "stranger_left" in done.stdout and "by module" in done.stdout
