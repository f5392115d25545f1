"""Training: a learner on a batch of worlds, from a configuration to a run folder."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from torch.distributions import Distribution

from lidarena.agents import checkpoint, run_folder
from lidarena.agents.batches import make_batch
from lidarena.agents.learners import make_model, normalized
from lidarena.agents.training_config import CONFIG_FILE, TrainingConfig
from lidarena.agents.training_run import TrainingRun, learn
from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import as_config, dump_config


def train(
    config: TrainingConfig | Mapping[str, Any] | str | Path | None = None,
    resume: str | Path | None = None,
    progress: bool = True,
    exact_out: bool = False,
) -> Path:
    """Train an agent.

    The first Ctrl-C (or SIGTERM) ends the training after the current update, with a checkpoint and the policy on the
    disk; the second one ends it at once, with the last checkpoint there.

    Args:
        config: What is trained: a YAML file, a dictionary of what one would hold, or what `lidarena.agents.load_config`
            made of one. May be left out with ``resume``.
        resume: Run folder of a training to go on with: from its last checkpoint, to the bit as if it had never stopped.
            A larger ``total_steps`` prolongs a training that had ended; one that has all its steps is left as it is.
        progress: Whether to show how far it is.
        exact_out: Whether ``config.out`` is refused, rather than numbered, if it already holds files.

    Returns:
        The run folder: ``config.yaml``, ``policy.safetensors`` and ``policy.json`` (for `lidarena.agents.load`),
        ``progress.csv``, TensorBoard events, and the last checkpoints.

    Raises:
        ConfigError: There is no such environment or keyword, a dictionary's key or value is wrong, the folder cannot be
            used or resumed, or the weights have left the finite numbers.
        TrainingStopped: Somebody stopped it; a `KeyboardInterrupt` that tells how to go on.
    """
    config = None if config is None else as_config(config, TrainingConfig)
    folder = None if resume is None else Path(resume)
    start: Path | None = None
    if folder is not None:
        config = config or run_folder.config_of(folder)
        start = run_folder.checkpoint_to_resume(folder, config)
        if start is not None and checkpoint.step_of(start) >= config.total_steps:
            _tell(f"{folder} already has its {config.total_steps:,} steps; a larger total_steps prolongs it", progress)
            return folder
    if config is None:
        raise ConfigError("a training needs a configuration, or a run folder to go on with")
    with _torch_settings(config.torch_threads), _model(config) as model:
        seconds, lost = (0.0, []) if start is None else checkpoint.restore(start, model, run_folder.fixed_part(config))
        folder = _folder_for(config, folder, start, exact_out, progress)
        _tell(f"run:      {folder}{f', from step {model.num_timesteps:,}' if start else ''}", progress)
        if start is None and (losing := checkpoint.lost_worlds(model)) is not None:
            lost = [losing]
        for one in lost:
            _tell(f"{'lost:    ' if start else 'a resumption will lose'} {one}", progress)
        dump_config(config.model_copy(update={"out": str(folder)}), folder / CONFIG_FILE)
        learn(TrainingRun(config, folder, model, seconds), progress)
    return folder


def _folder_for(
    config: TrainingConfig, resumed: Path | None, start: Path | None, exact_out: bool, progress: bool
) -> Path:
    """The run folder: a new one, or the one that is gone on in, cleared if the training begins anew there."""
    if resumed is None:
        return run_folder.claim(config.out, exact_out)
    if start is None:
        aside = run_folder.keep_policy(resumed)
        kept = f"; what it had is in {aside}" if aside else ""
        _tell(f"{resumed} has no checkpoint and begins anew{kept}", progress)
    return resumed


@contextmanager
def _model(config: TrainingConfig) -> Iterator[BaseAlgorithm]:
    batch = make_batch(config.env, config.num_envs)
    try:
        yield make_model(config, normalized(config, batch))
    finally:
        batch.close()


@contextmanager
def _torch_settings(threads: int) -> Iterator[None]:
    """Set PyTorch's threads, and leave out the checks that take a tenth of the learning: nothing here is user input."""
    before, checks = torch.get_num_threads(), Distribution._validate_args
    torch.set_num_threads(threads)
    Distribution.set_default_validate_args(False)
    try:
        yield
    finally:
        torch.set_num_threads(before)
        Distribution.set_default_validate_args(checks)


def _tell(line: str, progress: bool) -> None:
    if progress:
        print(line, flush=True)
