"""Earlier names of modules, and of what is in them: they work for one version with a warning that names the new one."""

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from importlib import import_module
from importlib.abc import InspectLoader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import CodeType, ModuleType
from typing import Any, TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., Any])

_INTO_A_FOLDER = {
    "agents.corridor": "shared_fleet_agent",
    "agents.exploration": "goal_choice_agent",
    "baselines.arena": "apf apf_global apf_improved apf_improved_lidar apf_lidar astar",
    "baselines.corridor": "deviation_model learn_deviation team_driving team_planners team_search",
    "baselines.exploration": "driving ealc frontier topological_graph",
    "envs.exploration": "coverage",
    "evaluation.team_planning": "team_experiment team_problems team_tables",
    "planning.grid": "frontiers grid_search inflation path_following steering",
    "planning.potential_field": "circle_grid disc_clearance field_descent field_parameters field_scene guided_field "
    "regression_search",
    "slam.logs": "calibration carmen relations replay replay_files replay_picture trajectory",
    "slam.rbpf": "likelihood_field particle_filter particle_filter_state scan_matching",
}
"""Modules that went down into a folder of their storey and kept their name."""

_ELSEWHERE = {
    "agents.yaml_config": "base.yaml_config",
    "baselines.arena_view": "baselines.arena.robot_interface",
    "baselines.fleet": "baselines.corridor.robot_interface",
    "baselines.goals": "baselines.exploration.goal_tracker",
    "baselines.path_driving": "baselines.arena.chord_follower",
    "baselines.robot": "baselines.exploration.robot_interface",
    "envs.arena_book": "envs.arena.scenarios",
    "envs.arena_options": "envs.arena.options",
    "envs.batch_infos": "envs.infos",
    "envs.batched_worlds": "envs.base_vector_env",
    "envs.corridor_central": "envs.corridor.central_env",
    "envs.corridor_episodes": "envs.corridor.episodes",
    "envs.corridor_options": "envs.corridor.options",
    "envs.corridor_shared": "envs.corridor.shared_env",
    "envs.drive_actions": "envs.exploration.actions",
    "envs.exploration_options": "envs.exploration.options",
    "envs.frontier_compass": "envs.exploration.frontier_directions",
    "envs.heading_actions": "envs.arena.actions",
    "envs.keyword_checks": "base.keyword_checks",
    "envs.single_world": "envs.base_env",
    "envs.team_actions": "envs.corridor.actions",
    "evaluation.arena_measures": "evaluation.measures.arena",
    "evaluation.map_quality": "evaluation.measures.exploration",
    "planning.team.roads": "planning.team.grid_graph",
    "world.drawing": "world.canvas",
    "world.kernels": "base.jit",
    "world.random_streams": "base.random_streams",
    "world.refusals": "base.errors",
}

_RENAMED = {
    "baselines.goals": {"GoalLedger": "GoalBlacklist"},
    "baselines.path_driving": {"PathFollower": "ChordFollower"},
    "envs.arena_book": {"ArenaBook": "ScenarioGenerator", "Course": "Scenario"},
    "planning.path_following": {"carrot": "lookahead_point"},
    "planning.team.roads": {"Roads": "GridGraph", "roads_of": "grid_graph_of"},
    "world.refusals": {"Refusal": "LidarenaError"},
}
"""What is called otherwise in the new module."""


def moved_modules() -> dict[str, str]:
    """Return where every module is now whose earlier name still works, by that name."""
    moved = {
        f"lidarena.{folder.rpartition('.')[0]}.{module}": f"lidarena.{folder}.{module}"
        for folder, modules in _INTO_A_FOLDER.items()
        for module in modules.split()
    }
    return moved | {f"lidarena.{old}": f"lidarena.{new}" for old, new in _ELSEWHERE.items()}


def renamed(module: str, names: Mapping[str, str]) -> Callable[[str], Any]:
    """Return a ``__getattr__`` for a module some of whose names were others earlier.

    Args:
        module: Its name.
        names: The names of now by the earlier ones.
    """

    def look_up(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        _warn(f"{module}.{name}", f"{module}.{names[name]}")
        return getattr(import_module(module), names[name])

    return look_up


def takes_old_keywords(**names: str) -> Callable[[Function], Function]:
    """Return a decorator for a function some of whose keywords were called otherwise earlier.

    Args:
        **names: The keywords of now by the earlier ones.
    """

    def decorate(function: Function) -> Function:
        @wraps(function)
        def call(*values: Any, **keywords: Any) -> Any:
            for old in names.keys() & keywords.keys():
                _warn(f"keyword {old!r} of {function.__name__}", repr(names[old]))
                keywords[names[old]] = keywords.pop(old)
            return function(*values, **keywords)

        return cast(Function, call)

    return decorate


def keep_old_names() -> None:
    """Let the earlier names of modules be imported; doing so again changes nothing."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.append(_Finder())


def _warn(old: str, new: str) -> None:
    warnings.warn(f"{old} is now {new}; the earlier name goes with the next version", DeprecationWarning, stacklevel=3)


class _Finder(MetaPathFinder):
    """Asked last, for what nobody else has found."""

    def __init__(self) -> None:
        self._moved = moved_modules()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return where a module is that had this name earlier."""
        if fullname not in self._moved:
            return None
        home = find_spec(self._moved[fullname])
        return None if home is None else ModuleSpec(fullname, _Loader(home), origin=home.origin)


class _Loader(InspectLoader):
    """Gives a module with an earlier name everything that is in the one of now."""

    def __init__(self, home: ModuleSpec) -> None:
        self._home = home

    def exec_module(self, module: ModuleType) -> None:
        """Fill the module."""
        names = _RENAMED.get(module.__name__.removeprefix("lidarena."), {})
        home = import_module(self._home.name)
        _warn(module.__name__, self._home.name)
        public = [name for name in dir(home) if not name.startswith("_")]
        module.__dict__.update({name: getattr(home, name) for name in public})
        module.__dict__.update({earlier: getattr(home, now) for earlier, now in names.items()})
        module.__doc__ = f"Earlier name of ``{self._home.name}``."

    def get_source(self, fullname: str) -> None:
        """There is none."""

    def get_code(self, fullname: str) -> CodeType | None:
        """Return the code of the module of now, which ``python -m`` runs."""
        assert isinstance(self._home.loader, InspectLoader)
        _warn(fullname, self._home.name)
        return self._home.loader.get_code(self._home.name)
