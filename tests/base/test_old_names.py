"""What users typed before still works, with a warning that names the new one."""

import subprocess
import sys
import warnings
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec

import pytest

import lidarena
from lidarena.base import old_names
from lidarena.base.old_names import keep_old_names, moved_modules, renamed

MOVED = moved_modules()


@pytest.fixture(autouse=True)
def forget() -> Iterator[None]:
    for name in MOVED:
        sys.modules.pop(name, None)
    yield
    for name in MOVED:
        sys.modules.pop(name, None)


@pytest.mark.parametrize("old", MOVED)
def test_a_module_that_moved_is_found_under_its_earlier_name(old: str) -> None:
    with pytest.warns(DeprecationWarning, match=f"{old} is now {MOVED[old]};") as told:
        module = import_module(old)
    assert len(told) == 1
    home = import_module(MOVED[old])
    own = [name for name, value in vars(home).items() if getattr(value, "__module__", None) == MOVED[old]]
    for name in [name for name in own if not name.startswith("_")]:
        assert getattr(module, name) is getattr(home, name)


def test_no_earlier_name_is_that_of_a_module_of_now() -> None:
    others = [one for one in sys.meta_path if hasattr(one, "find_spec") and not isinstance(one, old_names._Finder)]
    for name in MOVED:
        room = import_module(name.rpartition(".")[0])
        assert not any(finder.find_spec(name, room.__path__) for finder in others), name


@pytest.mark.parametrize(
    ("module", "old", "new"),
    [(module, old, new) for module, names in old_names._RENAMED.items() for old, new in names.items()],
)
def test_what_is_called_otherwise_is_found_too(module: str, old: str, new: str) -> None:
    with pytest.warns(DeprecationWarning):
        earlier = getattr(import_module(f"lidarena.{module}"), old)
    assert earlier is getattr(import_module(MOVED[f"lidarena.{module}"]), new)


def test_what_the_first_readme_typed_works() -> None:
    with pytest.warns(DeprecationWarning):
        from lidarena.agents.goal_choice_agent import GoalChoiceAgent  # noqa: F401
        from lidarena.agents.shared_fleet_agent import SharedFleetAgent  # noqa: F401
        from lidarena.slam.carmen import read_log  # noqa: F401
        from lidarena.slam.relations import relation_errors  # noqa: F401
        from lidarena.slam.replay import replay  # noqa: F401
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        from lidarena.envs import ExplorationEnv, corridor_v0  # noqa: F401
        from lidarena.envs.arena import ArenaEnv  # noqa: F401
        from lidarena.envs.exploration import BatchedExploration  # noqa: F401
        from lidarena.planning.potential_field import PotentialField, plan_path  # noqa: F401


def test_the_warning_points_at_who_imports() -> None:
    with pytest.warns(DeprecationWarning) as told:
        import lidarena.slam.carmen  # noqa: F401
    assert told[0].filename == __file__


def test_an_error_is_caught_under_its_earlier_name() -> None:
    with pytest.warns(DeprecationWarning):
        from lidarena.world.refusals import Refusal
    with pytest.raises(Refusal):
        lidarena.baselines.make("fronteer", object())


def test_a_program_that_moved_still_runs() -> None:
    command = [sys.executable, "-W", "default", "-m", "lidarena.baselines.learn_deviation", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0 and "usage" in done.stdout
    assert "lidarena.baselines.learn_deviation is now lidarena.baselines.corridor.learn_deviation" in done.stderr


def test_other_modules_are_still_missing() -> None:
    with pytest.raises(ModuleNotFoundError, match=r"lidarena\.slam\.carmem"):
        import_module("lidarena.slam.carmem")
    assert find_spec("lidarena.nothing") is None


def test_one_finder_is_enough() -> None:
    before = len(sys.meta_path)
    keep_old_names()
    assert len(sys.meta_path) == before


def test_a_name_within_a_module() -> None:
    look_up = renamed("lidarena.base.errors", {"Refusal": "LidarenaError"})
    with pytest.warns(DeprecationWarning, match=r"errors\.Refusal is now lidarena\.base\.errors\.LidarenaError"):
        assert look_up("Refusal") is import_module("lidarena.base.errors").LidarenaError
    with pytest.raises(AttributeError, match="has no attribute 'Refused'"):
        look_up("Refused")
