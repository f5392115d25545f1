"""All episodes of a comparison on all cores, in an order and with results that do not depend on the number of cores."""

import os
import signal
import sys
import traceback
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, ExitStack, closing, contextmanager, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NoReturn, TypeVar

import cv2
import numba

from lidarena.base.errors import LidarenaError, MapError
from lidarena.base.ray_cluster import ClusterError
from lidarena.base.worker_processes import available_cores, worker_pool
from lidarena.baselines import Policy
from lidarena.envs.compilation import announced_compilation, keep_quiet
from lidarena.evaluation.bag_recorder import BagRecorder
from lidarena.evaluation.comparison_config import ComparisonConfig, Engine
from lidarena.evaluation.episodes import Episode, run_episode
from lidarena.evaluation.participants import make_participants
from lidarena.evaluation.ray_engine import cluster_outcomes
from lidarena.evaluation.recording import Env
from lidarena.evaluation.tasks import Task
from lidarena.evaluation.videos import VideoRecorder

DRY_RUN_STEPS = 30
Outcome = TypeVar("Outcome")
THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class EpisodeError(RuntimeError):
    """An environment or a policy raised.

    Args:
        sentence: The message; it names both and the seed.
        report: The traceback, kept as an attribute.
    """

    def __init__(self, sentence: str, report: str = "") -> None:
        super().__init__(sentence)
        self.report = report


@dataclass(frozen=True)
class _Failure:
    """An exception as text: what a worker raised may not survive the way back as an object."""

    sentence: str
    report: str
    refused: bool
    of_map: bool = False


def dry_run(config: ComparisonConfig) -> None:
    """Run the first steps of every policy in every environment, so that mistakes show within seconds.

    It also compiles what the policies call, once instead of in every worker, and before anything is timed; and it draws
    what came of it onto nothing, so that a family's picture fails now or never.

    Raises:
        LidarenaError: A keyword, map, option or agent is refused.
        EpisodeError: Something else went wrong.
    """
    with announced_compilation(), _single_threaded():
        for env in config.worlds:
            cases = config.cases(env)
            for policy in config.participants:
                tried = Task(env, policy, config.seed, config.pictures, max_steps=DRY_RUN_STEPS)
                _try_one([replace(tried, case=case) for case in (cases if env.maps is not None else cases[:1])])


def _try_one(tasks: Sequence[Task]) -> None:
    """Run the first task whose map can be used, and draw what came of it; there is at least one.

    Raises:
        LidarenaError: It is refused, or no map can be used.
        EpisodeError: It failed.
    """
    failures: list[tuple[Task, _Failure]] = []
    for task in tasks:
        outcome = _guarded(partial(_try, task))
        if not isinstance(outcome, _Failure):
            return
        failures.append((task, outcome))
        if not outcome.of_map:
            break
    _raise(*(failures[0] if failures[-1][1].of_map else failures[-1]))


def _try(task: Task) -> None:
    from matplotlib.figure import Figure

    picture = _run(task).picture
    if picture is not None:
        picture.bounds()
        picture.draw(Figure().add_subplot())


def run_tasks(
    tasks: Sequence[Task],
    workers: int | None = None,
    advance: Callable[[Task], None] | None = None,
    engine: Engine = "processes",
    ray_address: str | None = None,
) -> list[Episode]:
    """Run episodes on several processes, or on a cluster.

    Args:
        tasks: What to run.
        workers: Processes; one per available core if None. With one, everything runs in this process.
        advance: Called in this process after each episode, in the order in which they end. Those of one seed run one
            after the other, since what a process keeps of a world it has drawn serves them all.
        engine: ``"processes"`` of this machine, or ``"ray"``.
        ray_address: Of the cluster, see ``lidarena.base.ray_cluster.ray_results``.

    Returns:
        One episode per task, in the tasks' order. Where a map of a folder could not be used it holds the ``error``.

    Raises:
        LidarenaError: A task was refused, or there is no cluster.
        EpisodeError: A task raised, or a process died (on a cluster twice). What had not begun is dropped.
    """
    count = min(workers or available_cores(), max(1, len(tasks)))
    order = sorted(range(len(tasks)), key=lambda index: tasks[index].seed)
    queue = [tasks[index] for index in order]
    pool: AbstractContextManager[Iterator[tuple[int, Episode | _Failure]]]
    if engine == "ray":
        pool = closing(_in_cluster(queue, count, ray_address))
    else:
        pool = _in_processes(queue, count) if count > 1 else nullcontext(_in_this_process(queue))
    episodes: dict[int, Episode] = {}
    with _single_threaded(), pool as outcomes:
        for place, outcome in outcomes:
            task = queue[place]
            episodes[order[place]] = outcome if isinstance(outcome, Episode) else _without(task, outcome)
            if advance:
                advance(task)
    return [episodes[index] for index in range(len(tasks))]


def _in_this_process(tasks: Sequence[Task]) -> Iterator[tuple[int, Episode | _Failure]]:
    for index, task in enumerate(tasks):
        yield index, _guarded(partial(_run, task))


def _in_cluster(
    tasks: Sequence[Task], cores: int, address: str | None
) -> Generator[tuple[int, Episode | _Failure], None, None]:
    try:
        yield from cluster_outcomes(_run_alone, tasks, address, cores, dict.fromkeys(THREAD_VARIABLES, "1"))
    except ClusterError as error:
        raise EpisodeError(f"{tasks[error.index]}: the worker or its node ended twice: {error}") from error


def _run_alone(task: Task) -> Episode | _Failure:
    """Run a task in a worker of a cluster."""
    numba.set_num_threads(1)
    cv2.setNumThreads(1)
    keep_quiet()
    return _guarded(partial(_run, task))


@contextmanager
def _in_processes(tasks: Sequence[Task], count: int) -> Iterator[Iterator[tuple[int, Episode | _Failure]]]:
    pool = worker_pool(count, _prepare_worker)
    try:
        yield _as_they_end(pool, tasks)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _prepare_worker() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends a worker without a traceback of its own
    numba.set_num_threads(1)
    cv2.setNumThreads(1)
    keep_quiet()  # the dry run has compiled and said so


def _as_they_end(pool: ProcessPoolExecutor, tasks: Sequence[Task]) -> Iterator[tuple[int, Episode | _Failure]]:
    futures = {pool.submit(_guarded, partial(_run, task)): index for index, task in enumerate(tasks)}
    try:
        for future in as_completed(futures):
            yield futures[future], future.result()
    except BrokenProcessPool as error:
        raise EpisodeError(
            "a worker process ended without an answer, which mostly means too little memory; "
            "run fewer at once with --set workers=1"
        ) from error


def _guarded(work: Callable[[], Outcome]) -> Outcome | _Failure:
    """Do it; whatever it raises comes back as text."""
    try:
        return work()
    except LidarenaError as refusal:
        return _Failure(str(refusal), traceback.format_exc(), refused=True, of_map=isinstance(refusal, MapError))
    except Exception as error:
        lines = str(error).strip().splitlines()
        sentence = f"{type(error).__name__}: {lines[0]}" if lines else type(error).__name__
        return _Failure(sentence, traceback.format_exc(), refused=False)


def _without(task: Task, failure: _Failure) -> Episode:
    """What stands for the episode of a map that could not be used; others of the folder can.

    Raises:
        LidarenaError: The task is not of a folder of maps, and was refused.
        EpisodeError: It is not, and failed.
    """
    if task.case is None:
        _raise(task, failure)
    return Episode(task.seed, (), {}, "error", map=task.case.name, error=failure.sentence)


def _raise(task: Task, failure: _Failure) -> NoReturn:
    if failure.refused:
        where = "" if task.case is None else f", map {task.case.name!r}"
        raise LidarenaError(f"environment {task.env.label!r}, policy {task.policy.title!r}{where}: {failure.sentence}")
    raise EpisodeError(f"{task}: {failure.sentence}", failure.report)


def _run(task: Task) -> Episode:
    entry = task.env.of_episode(task.seed, task.case)
    env, policy = make_participants(entry, task.policy, "rgb_array" if task.video else None)
    try:
        _limit_threads(1)
        episode = _recorded(task, env, policy)
        return replace(episode, map=task.case.name) if task.case is not None else episode
    finally:
        env.close()


def _recorded(task: Task, env: Env, policy: Policy) -> Episode:
    how: dict[str, Any] = {
        "max_steps": task.max_steps,
        "keep_picture": task.keep_picture,
        "keep_replay": task.keep_replay,
    }
    with ExitStack() as stack:
        if task.video is not None:
            how["record"] = stack.enter_context(VideoRecorder(task.video)).add
        if task.bag is not None:
            how["watch"] = stack.enter_context(BagRecorder(task.bag)).note
        return run_episode(env, policy, task.seed, **how)


@contextmanager
def _single_threaded() -> Iterator[None]:
    """One thread a process, here and in what is started: as many processes as cores would fight over them."""
    before = {name: os.environ.get(name) for name in THREAD_VARIABLES}
    torch_threads = sys.modules["torch"].get_num_threads() if "torch" in sys.modules else None
    os.environ.update(dict.fromkeys(THREAD_VARIABLES, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
        if torch_threads is not None:
            _limit_threads(torch_threads)


def _limit_threads(count: int) -> None:
    """Set the threads of torch, which reads its environment variable only while it is imported."""
    if "torch" in sys.modules:
        sys.modules["torch"].set_num_threads(count)
