import subprocess
import sys

import pytest

from lidarena import envs, slam


def test_a_name_is_what_its_module_has() -> None:
    from lidarena.envs.arena.env import ArenaEnv
    from lidarena.slam.logs.reading import read_recording

    assert envs.ArenaEnv is ArenaEnv
    assert slam.read_log is read_recording


def test_names_are_listed_and_others_refused() -> None:
    assert {"ArenaEnv", "set_num_threads", "register_all"} <= set(dir(envs))
    with pytest.raises(AttributeError, match=r"module 'lidarena\.envs' has no attribute 'ArenaEnvironment'"):
        envs.ArenaEnvironment  # noqa: B018


def test_an_environment_imports_its_own_family_alone() -> None:
    code = (
        "import sys, gymnasium, lidarena; gymnasium.make('lidarena/Arena-v0'); "
        "print([name for name in sys.modules if name.endswith('.env') and name.startswith('lidarena.envs.')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "['lidarena.envs.arena.env']"
