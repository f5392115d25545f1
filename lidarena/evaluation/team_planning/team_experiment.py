"""The experiments of Bennewitz & Burgard (section 3), Fig. 10, 12, 15 and 16, and the MovingAI benchmarks.

python evaluate.py --config configs/compare/team_planning.yaml
"""

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import as_completed
from dataclasses import dataclass, field
from functools import lru_cache, partial
from pathlib import Path
from typing import Literal

import numpy as np
import yaml
from pydantic import Field
from rich.console import Console

from lidarena.base.errors import ConfigError
from lidarena.base.worker_processes import available_cores, worker_pool
from lidarena.base.yaml_config import ConfigModel
from lidarena.evaluation.progress_report import report_progress
from lidarena.evaluation.team_planning.team_problems import (
    Problem,
    ProblemGrid,
    count_conflicts,
    problem_grid,
    problems,
    solve,
)
from lidarena.planning.team.plan import Method
from lidarena.world.movingai import load_movingai
from lidarena.world.scenario import load_scenario

METHODS: tuple[Method, ...] = ("prioritized_astar", "coordination", "prioritized_search")
ROBOTS = range(2, 7)
SHIPPED = Path(__file__).parent / "movingai"
"""The benchmarks that come with the package."""
_SCENARIOS = 10
_CHUNK = 25  # experiments a task


class MovingAI(ConfigModel):
    """Which MovingAI scenarios are solved.

    Attributes:
        folder: With ``map/NAME.map`` and ``scen-random/NAME-random-I.scen``, as movingai.com packs them; ``shipped``
            for the three that come with the package, up to 200 robots each; None leaves the table out.
        maps: Names.
        robots: Sizes of the teams.
        time_limit: Of one plan [s].
    """

    folder: str | None = None
    maps: list[str] = Field(default_factory=list)
    robots: list[int] = Field(default_factory=lambda: [6, 20, 50])
    time_limit: float = Field(default=0.5, gt=0)


class TeamExperimentConfig(ConfigModel):
    """A file of team experiments.

    Attributes:
        experiment: What tells such a file from a comparison.
        optimum_runs: Pairs that are compared with the joint optimum (Fig. 10); Bennewitz & Burgard's 10 or more.
        runs: Experiments for each environment and team size (Fig. 12, 15, 16); Bennewitz & Burgard's 900.
        iterations: Neighbourhoods and orders that ``prioritized_search`` may try in each.
        seed: Of the first problem.
        movingai: The benchmarks.
        workers: Processes; one per core if left out.
        out: Folder of the results.
    """

    experiment: Literal["team_planning"]
    optimum_runs: int = Field(default=100, ge=1)
    runs: int = Field(default=900, ge=1)
    iterations: int = Field(default=30, ge=1)
    seed: int = Field(default=0, ge=0)
    movingai: MovingAI = MovingAI()
    workers: int | None = Field(default=None, ge=1, le=1024)
    out: str = "results/team_planning"


@dataclass(frozen=True)
class Outcome:
    """One experiment.

    Attributes:
        env: Floor plan or map.
        robots: Size of the team.
        conflicts: Pairs of independent paths that conflict.
        bound: Sum of the independent paths' costs, or the joint optimum where there is one.
        costs: Cost of each method's plan; NaN where it found none.
        seconds: Time of the slowest plan.
    """

    env: str
    robots: int
    conflicts: int
    bound: float
    costs: dict[str, float] = field(default_factory=dict)
    seconds: float = 0.0


Task = Callable[[], list[Outcome]]


def run_experiments(config: TeamExperimentConfig, console: Console) -> dict[str, list[Outcome]]:
    """Run everything on several processes; what comes out does not depend on how many.

    Returns:
        Outcomes by ``optimum``, ``teams`` and ``movingai``.

    Raises:
        ConfigError: A MovingAI file is named that is not there.
    """
    tasks: list[tuple[str, Task]] = [("optimum", partial(_optimum, config.optimum_runs, config.seed))]
    for env in ("office", "unstructured"):
        for robots in ROBOTS:
            for start in range(0, config.runs, _CHUNK):
                count = min(_CHUNK, config.runs - start)
                tasks.append(("teams", partial(_teams, env, robots, config.seed + start, count, config.iterations)))
    tasks += [("movingai", task) for task in _movingai_tasks(config.movingai)]
    found: dict[int, list[Outcome]] = {}
    with report_progress(len(tasks), console) as advance:
        for index, outcomes in _in_processes([task for _, task in tasks], config.workers or available_cores()):
            found[index] = outcomes
            advance(f"{outcomes[0].env}, {outcomes[0].robots} robots" if outcomes else "")
    groups: dict[str, list[Outcome]] = {"optimum": [], "teams": [], "movingai": []}
    for index, (group, _) in enumerate(tasks):
        groups[group] += found[index]
    return groups


def _in_processes(tasks: Sequence[Task], workers: int) -> Iterator[tuple[int, list[Outcome]]]:
    if workers == 1:
        yield from ((index, task()) for index, task in enumerate(tasks))
        return
    with worker_pool(workers) as pool:
        futures = {pool.submit(task): index for index, task in enumerate(tasks)}
        for future in as_completed(futures):
            yield futures[future], future.result()


@lru_cache(maxsize=8)
def _grid(env: str, cell: float) -> ProblemGrid:
    return problem_grid(env, cell, 0.0 if cell > 0.5 else 0.2)


def _optimum(count: int, seed: int) -> list[Outcome]:
    """Fig. 10: pairs on 60 cm cells whose paths conflict and can be coordinated, beside the joint optimum."""
    outcomes: list[Outcome] = []
    for problem in problems(_grid("office", 0.6), 2, seed):
        if solve(problem, "independent_astar").solved:
            continue
        optimum, coordinated = solve(problem, "joint_astar", 60.0), solve(problem, "coordination")
        if optimum.solved and coordinated.solved:
            costs = _costs(problem, 200) | {"coordination": coordinated.cost}
            outcomes.append(Outcome("office, 60 cm", 2, 1, optimum.cost, costs))
        if len(outcomes) == count:
            break
    return outcomes


def _teams(env: str, robots: int, seed: int, count: int, iterations: int) -> list[Outcome]:
    """Fig. 12, 15, 16: random teams; those without a conflict are noted and not planned further."""
    outcomes = []
    grid = _grid(env, 0.2)
    for problem, _ in zip(problems(grid, robots, 10_000 + seed), range(count), strict=False):
        alone = solve(problem, "independent_astar")
        conflicts = 0 if alone.solved else count_conflicts(alone, grid.graph.apart)
        costs = _costs(problem, iterations) if conflicts else {}
        outcomes.append(Outcome(env, robots, conflicts, alone.lower_bound, costs))
    return outcomes


def _costs(problem: Problem, iterations: int) -> dict[str, float]:
    plans = {m: solve(problem, m, iterations=iterations) for m in METHODS}
    return {method: plan.cost if plan.solved else np.nan for method, plan in plans.items()}


def _movingai_tasks(config: MovingAI) -> Iterable[Task]:
    if config.folder is None:
        return []
    folder = SHIPPED if config.folder == "shipped" else Path(config.folder)
    tasks = []
    for name in config.maps:
        numbers = range(1, _SCENARIOS + 1)
        for file in (_map_file(folder, name), *(_scenario_file(folder, name, number) for number in numbers)):
            if not file.is_file():
                raise ConfigError(
                    f"there is no {file}; movingai.folder must hold map/ and scen-random/ from movingai.com, or be "
                    "'shipped' for those of the package, or null to leave them out"
                )
        for robots in config.robots:
            tasks += [partial(_movingai, folder, name, robots, number, config.time_limit) for number in numbers]
    return tasks


def _map_file(folder: Path, name: str) -> Path:
    return folder / "map" / f"{name}.map"


def _scenario_file(folder: Path, name: str, number: int) -> Path:
    return folder / "scen-random" / f"{name}-random-{number}.scen"


def _movingai(folder: Path, name: str, robots: int, number: int, time_limit: float) -> list[Outcome]:
    free = load_movingai(_map_file(folder, name))
    scenario = load_scenario(_scenario_file(folder, name, number), free, robots, f"{name}.map")
    problem = Problem(~free, scenario.starts, scenario.goals, 0.0, 4)
    solve(problem, "prioritized_search", iterations=1)  # loads the kernels
    begin = time.perf_counter()
    plan = solve(problem, "prioritized_search", time_limit)
    seconds = time.perf_counter() - begin
    cost = plan.cost if plan.solved else np.nan
    return [Outcome(name, robots, 1, plan.lower_bound, {"prioritized_search": cost}, seconds)]


def is_team_experiment(path: str | Path) -> bool:
    """Whether a configuration file is one of team experiments, by its key ``experiment``."""
    try:
        content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError, yaml.YAMLError):
        return False  # whoever loads it says what is wrong with it
    return isinstance(content, dict) and content.get("experiment") is not None
