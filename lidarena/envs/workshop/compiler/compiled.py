"""A compiled task: its plans, how long they take, and what can be ensured by each; kept in the user's cache folder."""

import io
import os
import sys
import warnings
import zipfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import WriteError
from lidarena.base.files import write_bytes
from lidarena.envs.workshop.compiler.motion import WorkspaceMotion, acquire_motion
from lidarena.envs.workshop.compiler.networks import CATEGORIES, INCONSISTENT, categorize, plan_network
from lidarena.envs.workshop.compiler.plans import enumerate_plans
from lidarena.envs.workshop.compiler.schedule import PlanProblem, Snapshot, predict, predict_all, search_plans
from lidarena.envs.workshop.task import HUMAN, ROBOT, WorkshopTask
from lidarena.temporal import STNU

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_PLANS = 3000
"""Beyond so many plans a task's are found lazily, by search from what has been done."""
BEST_PLANS = 300
"""Of those that are found lazily, so many are listed."""
_NODES = 3_000_000
_VERSION = 3
"""Of the cached files."""


@dataclass(frozen=True)
class CompiledTask:
    """What the compiler makes of a task.

    Attributes:
        task: What is to be done.
        motion: Durations of the ways.
        plans: (P, 2, n) sequences of human and robot, the quickest plan first.
        makespans: (P,) with usual durations [s].
        categories: (P,) of their networks, see ``CATEGORIES``.
        complete: Whether these are all plans.
    """

    task: WorkshopTask
    motion: WorkspaceMotion
    plans: Ints
    makespans: Floats
    categories: Ints
    complete: bool

    @property
    def problem(self) -> PlanProblem:
        """For schedules."""
        return plan_problem(self.task, self.motion)

    def network(self, plan: int) -> STNU:
        """The temporal network of a plan."""
        start = beginning(self.task, self.motion)
        return plan_network(self.task, self.plans[plan], predict(self.problem, start, self.plans[plan]))

    def __str__(self) -> str:
        counts = np.bincount(self.categories, minlength=3)
        which = "plans" if self.complete else "quickest of very many plans"
        parts = ", ".join(f"{number} {name}" for number, name in zip(counts, CATEGORIES, strict=True))
        return f"task {self.task.name!r}: {len(self.plans)} {which}, {parts}; quickest {self.makespans[0]:.1f} s"


def plan_problem(task: WorkshopTask, motion: WorkspaceMotion) -> PlanProblem:
    """What schedules need to know; usual are the middle of the human's bounds and the robot's least time."""
    arrays = task.arrays
    usual = np.stack([np.sqrt(arrays.lower[HUMAN] * arrays.upper[HUMAN]), arrays.lower[ROBOT]])
    quickest = np.nanmin(usual, axis=0)
    tail = quickest.copy()
    for _ in tail:
        last = arrays.share[np.arange(len(tail)), arrays.stop_count - 1] * quickest
        behind = np.where(arrays.before, (tail - quickest + last)[None, :], 0.0).max(axis=1)
        tail = quickest + behind
    return PlanProblem(
        arrays.before, arrays.capable, usual, arrays.stops, arrays.stop_count, arrays.share, motion.time, motion.near,
        tail, np.argsort(-arrays.tail, kind="stable"),
    )  # fmt: skip


def beginning(task: WorkshopTask, motion: WorkspaceMotion) -> Snapshot:
    """Nothing has been done: both are at home."""
    count, stops = len(task.actions), task.arrays.stops.shape[1]
    home, stays = task.arrays.home, np.full((2, stops, 3), -1.0)
    first = np.stack([motion.time[agent, home[agent], :, -1] for agent in range(2)])
    never = np.full(count, np.inf)
    return Snapshot(np.zeros(2), home.copy(), first, never, never.copy(), stays)


def compile_task(
    task: WorkshopTask, separation: float = 0.4, space: bool = True, progress: bool = False, cache: bool = True
) -> CompiledTask:
    """Compile a task: plans, motion durations, and the category of each plan's network.

    A deadline that no plan can meet is no error: a warning says so.

    Args:
        task: What is to be done.
        separation: Distance between the two that is kept on the floor [m].
        space: Whether ways take time.
        progress: Show how far it is.
        cache: Keep the result in the user's cache folder (``LIDARENA_CACHE``, else the system's), and look there first.
    """
    file = cache_folder() / f"{task.key}-{separation:g}-{'space' if space else 'none'}-{_VERSION}.npz"
    compiled = _read(file, task) if cache else None
    if compiled is None:
        compiled = _compile(task, acquire_motion(task, separation, space), progress)
        if cache:
            _write(file, compiled)
    if (compiled.categories == INCONSISTENT).all():
        warnings.warn(
            f"no plan of task {task.name!r} meets its deadline of {task.deadline:g} s: the quickest takes "
            f"{compiled.makespans[0]:.0f} s; it is done all the same, only later",
            stacklevel=2,
        )
    return compiled


def _compile(task: WorkshopTask, motion: WorkspaceMotion, progress: bool) -> CompiledTask:
    problem, start = plan_problem(task, motion), beginning(task, motion)
    plans, complete = enumerate_plans(task.arrays, MOST_PLANS), True
    if plans is None:
        _, plans, _ = search_plans(problem, start, BEST_PLANS, _NODES)
        complete = False
    spans = predict_all(problem, start, plans)
    order = np.argsort(spans, kind="stable")
    plans, spans = plans[order], spans[order]
    categories = np.empty(len(plans), np.int64)
    for number, plan in enumerate(_shown(plans, progress)):
        categories[number] = categorize(plan_network(task, plan, predict(problem, start, plan)))
    return CompiledTask(task, motion, plans, spans, categories, complete)


def _shown(plans: Ints, progress: bool) -> Any:
    if not progress:
        return plans
    from rich.console import Console
    from rich.progress import track

    return track(plans, "checking plans", console=Console(file=sys.stderr))


def cache_folder() -> Path:
    """Where compiled tasks are kept."""
    own = os.environ.get("LIDARENA_CACHE")
    if own:
        return Path(own)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "lidarena" / "workshop"


def _read(file: Path, task: WorkshopTask) -> CompiledTask | None:
    """A compiled task; None if there is none, or its file is torn."""
    try:
        with np.load(io.BytesIO(file.read_bytes()), allow_pickle=False) as saved:
            motion = WorkspaceMotion(saved["time"], saved["near"])
            found = (saved["plans"], saved["makespans"], saved["categories"], bool(saved["complete"]))
            return CompiledTask(task, motion, *found)
    except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
        return None


def _write(file: Path, compiled: CompiledTask) -> None:
    """Keep it, where that is possible."""
    content = io.BytesIO()
    np.savez_compressed(
        content, time=compiled.motion.time, near=compiled.motion.near, plans=compiled.plans,
        makespans=compiled.makespans, categories=compiled.categories, complete=np.array(compiled.complete),
    )  # fmt: skip
    with suppress(WriteError):  # without a cache it only takes longer next time
        write_bytes(file, content.getvalue())
