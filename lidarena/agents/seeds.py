"""The same training with several seeds, side by side on this machine's cores or on a Ray cluster."""

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import as_completed
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal

from lidarena.agents.run_folder import claim
from lidarena.agents.training import train
from lidarena.agents.training_config import CONFIG_FILE, TrainingConfig
from lidarena.base.errors import ConfigError, LidarenaError
from lidarena.base.folder_contents import Contents, read_contents, write_contents
from lidarena.base.ray_cluster import ClusterError, ray_results
from lidarena.base.worker_processes import available_cores, worker_pool
from lidarena.base.yaml_config import as_config, dump_config

Engine = Literal["processes", "ray"]


@dataclass(frozen=True)
class _Trained:
    """What a worker sends back: the run folder's files, or why there are none."""

    files: Contents
    refusal: str | None = None


def train_seeds(
    config: TrainingConfig | Mapping[str, Any] | str | Path,
    seeds: Sequence[int],
    engine: Engine = "processes",
    ray_address: str | None = None,
    tell: Callable[[str], None] | None = None,
) -> list[Path]:
    """Train an agent once with each of several seeds; the runs are to the bit those of `lidarena.agents.train`.

    Args:
        config: What is trained, see `lidarena.agents.train`; its own seed does not count.
        seeds: One training each.
        engine: As many at once as this machine has cores, or on a Ray cluster.
        ray_address: Of the cluster, see `lidarena.base.ray_cluster.ray_results`.
        tell: Called with a line as each training ends.

    Returns:
        The run folders ``out/seed0``, …, in the order of the seeds.

    Raises:
        ConfigError: No seeds, one twice, or a folder that is taken; whatever a training refuses; no cluster.
    """
    checked = as_config(config, TrainingConfig)
    if not seeds or len(set(seeds)) != len(seeds):
        raise ConfigError(f"seeds = {list(seeds)!r} must be whole numbers, each of them once")
    plans = [checked.model_copy(update={"seed": seed, "out": str(Path(checked.out) / f"seed{seed}")}) for seed in seeds]
    folders = [claim(plan.out, exact=True) for plan in plans]
    try:
        for index, ended in _trained(plans, engine, ray_address):
            _keep(ended, plans[index])
            if tell is not None:
                tell(f"seed {seeds[index]}: {folders[index]}")
    finally:
        for folder in folders:
            if not any(folder.iterdir()):
                folder.rmdir()
    return folders


def _trained(plans: Sequence[TrainingConfig], engine: Engine, address: str | None) -> Iterator[tuple[int, _Trained]]:
    if engine == "ray":
        threads = str(max(plan.torch_threads for plan in plans))
        try:
            yield from ray_results(_train_apart, plans, address, None, {"OMP_NUM_THREADS": threads})
        except ClusterError as error:
            raise ConfigError(f"seed {plans[error.index].seed}: the worker or its node ended twice: {error}") from error
        return
    pool = worker_pool(min(available_cores(), len(plans)))
    try:
        futures = {pool.submit(partial(_train_apart, plan)): index for index, plan in enumerate(plans)}
        for future in as_completed(futures):
            yield futures[future], future.result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _train_apart(plan: TrainingConfig) -> _Trained:
    """Train in a folder of this worker's own, since on a cluster its disk may be no one else's."""
    with tempfile.TemporaryDirectory() as place:
        try:
            folder = train(plan.model_copy(update={"out": str(Path(place) / "run")}), progress=False)
        except LidarenaError as refusal:
            return _Trained({}, str(refusal))
        return _Trained(read_contents(folder))


def _keep(ended: _Trained, plan: TrainingConfig) -> None:
    """Write a run folder as if the training had been made in it.

    Raises:
        ConfigError: The training was refused.
    """
    if ended.refusal is not None:
        raise ConfigError(f"seed {plan.seed}: {ended.refusal}")
    write_contents(Path(plan.out), ended.files)
    dump_config(plan, Path(plan.out) / CONFIG_FILE)
