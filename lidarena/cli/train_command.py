"""``lidarena train``: train an agent from a configuration, or go on with a training."""

import argparse
import json
import sys
from typing import TYPE_CHECKING

from lidarena.base.errors import ConfigError, LidarenaError
from lidarena.cli.config_names import find_config
from lidarena.cli.engine_options import add_engine
from lidarena.cli.shell_completion import complete_names
from lidarena.cli.standalone import run_alone

if TYPE_CHECKING:
    from lidarena.agents.seeds import Engine
    from lidarena.agents.training_config import TrainingConfig

_TEXT = "Train an agent from a YAML file, or go on with a training."


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's."""
    parser = commands.add_parser("train", help="train an agent, or go on with a training", description=_TEXT)
    _add_options(parser)


def main(arguments: list[str] | None = None) -> int:
    """Run a training; return 0, 2 for a refusal, 130 after Ctrl-C."""
    return run_alone(_TEXT, _add_options, arguments)


def run(options: argparse.Namespace) -> int:
    """Run a training; return 0, 2 for a refusal, 130 after Ctrl-C."""
    from lidarena import agents  # here, since it takes seconds to load PyTorch

    _check(options)
    options.config = options.config or options.name
    try:
        config = _config(options)
        print(_summary(config), flush=True)
        if options.seeds is not None:
            return _train_seeds(config, options)
        folder = agents.train(config, resume=options.resume, exact_out=bool(options.out))
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    except OSError as error:  # of TensorBoard's writer; a full disk raises without a name
        place = repr(error.filename or options.resume or config.out)
        print(f"the training has stopped: {place} cannot be written: {error.strerror}", file=sys.stderr)
        return 2
    except agents.TrainingStopped as stopped:
        print(stopped, file=sys.stderr)
        return 130
    except KeyboardInterrupt:
        print("interrupted before the training began; nothing was written", file=sys.stderr)
        return 130
    print(f"policy:   {folder}/policy.safetensors (also policy.json; in Python lidarena.agents.load({str(folder)!r}))")
    print(f"curve:    {folder}/progress.csv, or tensorboard --logdir {folder}")
    print(f"go on:    lidarena train --resume {folder} --set total_steps=N")
    return 0


def _check(options: argparse.Namespace) -> None:
    """Refuse options that do not go together."""
    if options.name and options.config:
        options.refuse("give the configuration once, by its name or with --config")
    if not options.config and not options.name and not options.resume:
        options.refuse("give a configuration's name or --config FILE to start a training, or --resume DIR to go on")
    if options.seeds is not None and options.resume:
        options.refuse("--seeds is for new trainings; --resume goes on with one")
    if options.seeds is None and (options.engine or options.ray_address):
        options.refuse("--engine and --ray-address spread the trainings of --seeds")
    if options.out and options.resume:
        options.refuse("--out is for a new training; --resume goes on in its own folder")


def _train_seeds(config: "TrainingConfig", options: argparse.Namespace) -> int:
    from lidarena import agents

    engine: Engine = options.engine or "processes"
    try:
        folders = agents.train_seeds(config, _seeds_of(options.seeds), engine, options.ray_address, print)
    except KeyboardInterrupt:
        print("interrupted; the seeds named above are trained, of the others nothing was written", file=sys.stderr)
        return 130
    print(f"policies: {', '.join(map(str, folders))}")
    return 0


def _seeds_of(text: str) -> list[int]:
    """Seeds as ``0..9`` or ``0,3,5``.

    Raises:
        ConfigError: Neither.
    """
    first, dots, last = text.partition("..")
    parts = [first, last] if dots else text.split(",")
    if not all(part.strip().isdecimal() for part in parts):
        raise ConfigError(f"--seeds {text} is neither a range such as 0..9 nor a list such as 0,3,5")
    numbers = [int(part) for part in parts]
    return list(range(numbers[0], numbers[1] + 1)) if dots else numbers


def _config(options: argparse.Namespace) -> "TrainingConfig":
    from lidarena import agents
    from lidarena.agents.run_folder import config_of
    from lidarena.agents.training_config import TrainingConfig

    overrides = [*options.set, *([f"out={json.dumps(options.out)}"] if options.out else [])]
    if options.config:
        return agents.load_config(find_config("train", options.config), TrainingConfig, overrides)
    return config_of(options.resume, overrides)


def _summary(config: "TrainingConfig") -> str:
    """What is going to happen, in three lines."""
    keywords = "".join(f", {key}={value!r}" for key, value in config.env.keywords.items())
    return (
        f"env:      {config.env.id}{keywords}\n"
        f"schedule: {config.total_steps:,} steps of {config.num_envs} worlds, seed {config.seed}, "
        f"a checkpoint every {config.checkpoint_every:,}\n"
        f"learner:  {config.algorithm}, {_learner(config)}, learning rate {config.learner.learning_rate}"
    )


def _learner(config: "TrainingConfig") -> str:
    from lidarena.agents.learner_config import PPOConfig

    learner, worlds = config.learner, config.num_envs
    if isinstance(learner, PPOConfig):
        batches = f"batches of {learner.batch_size}, {learner.n_epochs} epochs"
        return f"{learner.n_steps} steps × {worlds} worlds an update, {batches}"
    return (
        f"{learner.train_freq} steps × {worlds} worlds and {learner.gradient_steps} batches of {learner.batch_size} "
        f"an update, a memory of {learner.buffer_size:,}"
    )


def _add_options(parser: argparse.ArgumentParser) -> None:
    name_help = "a shipped configuration, such as quick (see lidarena list configs), or a file"
    complete_names(parser.add_argument("name", nargs="?", metavar="NAME", help=name_help), "train")
    parser.add_argument("--config", metavar="FILE", help="training file, such as configs/train/quick.yaml")
    set_help = "override keys of the file, such as ppo.n_steps=256"
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="KEY=VALUE", help=set_help)
    out_help = "run folder, over the file's own 'out'; refused if it already holds files"
    parser.add_argument("--out", metavar="DIR", help=out_help)
    parser.add_argument(
        "--resume", metavar="DIR", help="run folder of a training to go on with, from its last checkpoint"
    )
    seeds_help = "train once with each, such as 0..9 or 0,3,5, into DIR/seed0, …; side by side on all cores"
    parser.add_argument("--seeds", metavar="SEEDS", help=seeds_help)
    add_engine(parser)
    parser.set_defaults(run=run, refuse=parser.error)
