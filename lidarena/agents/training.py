"""Training: PPO of Stable-Baselines3 on a batch of worlds, from a configuration to a run folder."""

import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.utils import LinearSchedule
from stable_baselines3.common.vec_env import VecEnv, VecNormalize
from torch.distributions import Distribution

from lidarena.agents import checkpoint, run_folder
from lidarena.agents.interruption import StopRequest, TrainingStopped, stop_on_signal
from lidarena.agents.learning_curve import LearningCurve
from lidarena.agents.networks import ACTIVATIONS, all_finite, class_for, policy_class, weights_of
from lidarena.agents.policy_file import save_policy
from lidarena.agents.progress import ProgressDisplay, show_progress
from lidarena.agents.training_config import CONFIG_FILE, EnvironmentConfig, Linear, TrainingConfig
from lidarena.agents.vec_env import BatchVecEnv
from lidarena.base.errors import ConfigError, suggest
from lidarena.base.yaml_config import dump_config


def train(
    config: TrainingConfig | None = None,
    resume: str | Path | None = None,
    progress: bool = True,
    exact_out: bool = False,
) -> Path:
    """Train an agent.

    The first Ctrl-C (or SIGTERM) ends the training after the current update, with a checkpoint and the policy on the
    disk; the second one ends it at once, with the last checkpoint there.

    Args:
        config: What is trained. May be left out with ``resume``.
        resume: Run folder of a training to go on with: from its last checkpoint, to the bit as if it had never stopped.
            A larger ``total_steps`` prolongs a training that had ended; one that has all its steps is left as it is.
        progress: Whether to show how far it is.
        exact_out: Whether ``config.out`` is refused, rather than numbered, if it already holds files.

    Returns:
        The run folder: ``config.yaml``, ``policy.safetensors`` and ``policy.json`` (for `lidarena.agents.load`),
        ``progress.csv``, TensorBoard events, and the last checkpoints.

    Raises:
        ConfigError: There is no such environment or keyword, the folder cannot be used or resumed, or the weights have
            left the finite numbers.
        TrainingStopped: Somebody stopped it; a `KeyboardInterrupt` that tells how to go on.
    """
    if resume is not None:
        folder = Path(resume)
        config = config or run_folder.config_of(folder)
        start = run_folder.checkpoint_to_resume(folder, config)
        if start is not None and checkpoint.step_of(start) >= config.total_steps:
            _tell(f"{folder} already has its {config.total_steps:,} steps; a larger total_steps prolongs it", progress)
            return folder
    elif config is None:
        raise ConfigError("a training needs a configuration, or a run folder to go on with")
    else:
        start = None
    with _torch_settings(config.torch_threads), _model(config) as model:
        if resume is None:
            folder = run_folder.claim(config.out, exact_out)
        seconds = checkpoint.restore(start, model, run_folder.fixed_part(config)) if start else 0.0
        if resume is not None and start is None:
            aside = run_folder.keep_policy(folder)
            _tell(
                f"{folder} has no checkpoint and begins anew{f'; what it had is in {aside}' if aside else ''}", progress
            )
        _tell(f"run:      {folder}{f', from step {model.num_timesteps:,}' if start else ''}", progress)
        dump_config(config.model_copy(update={"out": str(folder)}), folder / CONFIG_FILE)
        _run(_Run(config, folder, model, seconds), progress)
    return folder


def make_batch(env: EnvironmentConfig, num_envs: int) -> BatchVecEnv:
    """Make a batch of worlds for Stable-Baselines3.

    Raises:
        ConfigError: There is no such environment or keyword, or it has no batch of its own.
    """
    module, _, name = env.id.rpartition(":")
    try:
        batch = gym.make_vec(env.id, num_envs=num_envs, vectorization_mode="vector_entry_point", **env.keywords)
    except ModuleNotFoundError:
        raise ConfigError(f"'env.id' is {env.id!r}, but the module {module!r} cannot be imported") from None
    except gym.error.UnregisteredEnv:
        known = [known for known in gym.registry if known.partition("/")[0] in ("lidarena", name.partition("/")[0])]
        raise ConfigError(f"there is no environment {env.id!r}{suggest(name, known)}") from None
    except (TypeError, gym.error.Error) as error:
        raise ConfigError(f"the environment {env.id!r} cannot be made: {str(error).splitlines()[0]}") from None
    return BatchVecEnv(batch)


def make_model(config: TrainingConfig, env: VecEnv) -> PPO:
    """Make PPO with fresh weights, and seed Python's, NumPy's and PyTorch's generators as well as the worlds.

    Raises:
        ConfigError: The policy cannot read the observations, or there is no such device.
    """
    if config.device == "cuda" and not torch.cuda.is_available():
        raise ConfigError("'device' is 'cuda', but PyTorch finds no CUDA device here; allowed here: cpu")
    settings = {name: _schedule(value) for name, value in config.ppo}
    network: dict[str, Any] = {
        "activation_fn": ACTIVATIONS[config.policy.activation],
        "optimizer_kwargs": {"eps": 1e-5, "fused": True},  # Stable-Baselines3's ε; one kernel in place of a dozen
    }
    if config.policy.net_arch is not None:
        network["net_arch"] = config.policy.net_arch
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="You are trying to run PPO on the GPU")  # the user asked for it
        model = PPO(
            policy_class(class_for(config.policy, env.observation_space)),
            env,
            policy_kwargs=network,
            seed=config.seed,
            device=config.device,
            **settings,
        )
    env.seed(first_world_seed(config.seed))
    return model


def first_world_seed(seed: int) -> int:
    """Seed of a training's first world; the next ones count on from it.

    Trainings with the seeds 0 and 1 would share all worlds but two if their worlds began to count there.
    """
    return int(np.random.SeedSequence(seed).generate_state(1)[0])


_EPISODE_MEANS = {
    "r": "ep_rew_mean",
    "l": "ep_len_mean",
    "completeness": "completeness",
    "success": "success_rate",
    "collision": "collision_rate",
}
"""What an ended episode tells, and what its mean is called."""
_SUMMARY = {"ep_rew_mean": "return {:.1f}", "completeness": "completeness {:.0%}", "success_rate": "success {:.0%}"}
_SUMMARY |= {"collision_rate": "collisions {:.0%}"}


class _Stopped(Exception):  # noqa: N818  not an error: it carries the wish to stop out of Stable-Baselines3's loop
    pass


class _Run:
    """A training in its folder: what happens between two updates."""

    def __init__(self, config: TrainingConfig, folder: Path, model: PPO, seconds: float) -> None:
        self.config, self.folder, self.model = config, folder, model
        self.curve = LearningCurve(folder, after=model.num_timesteps)
        self._saved_at = self._row_at = model.num_timesteps
        self._seconds, self._row_seconds = seconds, seconds
        self._began = time.perf_counter()

    @property
    def seconds(self) -> float:
        """Seconds of training, those before a resumption included."""
        return self._seconds + time.perf_counter() - self._began

    def end_update(self, last: bool) -> str:
        """Write the row of the learning curve and, if due, the policy and a checkpoint.

        Returns:
            How good the agent is by now, in words.
        """
        step = self.model.num_timesteps
        if not all_finite(weights_of(self.model.policy)):
            raise ConfigError(
                f"the training has failed at step {step:,}: the weights are no longer finite numbers; "
                f"try a smaller ppo.learning_rate than {self.config.ppo.learning_rate}, or normalize_reward: true"
            )
        values = self._values(step)
        self.curve.add(step, self.seconds, values)
        self._row_at, self._row_seconds = step, self.seconds
        if last or step // self.config.checkpoint_every > self._saved_at // self.config.checkpoint_every:
            self.save(last)
        return _summary(values)

    def save(self, last: bool) -> None:
        """Write policy and checkpoint; the old ones stay until the new ones are whole."""
        self.save_policy()
        made_with = run_folder.fixed_part(self.config)
        checkpoint.save(self.folder, self.model, self.seconds, made_with, keep=1 if last else checkpoint.KEPT)
        self._saved_at = self.model.num_timesteps

    def save_policy(self) -> None:
        """Write the policy alone."""
        config = self.config
        about = {
            "algorithm": "PPO",
            "steps": self.model.num_timesteps,
            "total_steps": config.total_steps,
            "seed": config.seed,
            "num_envs": config.num_envs,
            "episodes": checkpoint.batch_of(self.model).episodes,
            "seconds": round(self.seconds, 1),
        }
        save_policy(self.model, self.folder, config.env.id, config.env.keywords, about)

    def _values(self, step: int) -> dict[str, float]:
        """Everything that is logged for the update that has just ended."""
        values = {name: float(value) for name, value in self.model.logger.name_to_value.items()}
        self.model.logger.name_to_value.clear()
        episodes = list(self.model.ep_info_buffer or ())
        for key, name in _EPISODE_MEANS.items():
            known = [episode[key] for episode in episodes if key in episode]
            if known:
                values[f"rollout/{name}"] = sum(known) / len(known)
        values["rollout/episodes"] = checkpoint.batch_of(self.model).episodes
        values["time/steps_per_second"] = (step - self._row_at) / max(self.seconds - self._row_seconds, 1e-9)
        return values


class _BetweenUpdates(BaseCallback):
    """Calls the run at the start of every rollout, which is the end of an update, and moves the display."""

    def __init__(self, run: _Run, display: ProgressDisplay, stop: StopRequest) -> None:
        super().__init__()
        self._run, self._display, self._stop = run, display, stop
        self._first = True

    def _on_rollout_start(self) -> None:
        if not self._first:
            self._display.update(self.num_timesteps, self._run.end_update(last=self._stop.requested))
        if self._stop.requested:
            raise _Stopped
        self._first = False

    def _on_rollout_end(self) -> None:
        # Numba sets OpenMP's number of threads, and so PyTorch's, where worlds of one's own start its pool.
        torch.set_num_threads(self._run.config.torch_threads)

    def _on_step(self) -> bool:
        self._display.update(self.num_timesteps)
        return True


def _run(run: _Run, progress: bool) -> None:
    """Let Stable-Baselines3 learn until the end or until somebody stops it."""
    model, config = run.model, run.config
    begun = model.num_timesteps
    display = show_progress(config.total_steps, begun, progress)
    model.set_logger(Logger(folder=None, output_formats=[]))  # the learning curve writes; SB3's own would leave folders
    try:
        with stop_on_signal() as stop:
            model.learn(
                config.total_steps - begun,
                callback=_BetweenUpdates(run, display, stop),
                log_interval=None,  # type: ignore[arg-type]  # never: rows are written after the update, not before it
                reset_num_timesteps=begun == 0,
            )
            display.update(model.num_timesteps, run.end_update(last=True))
    except (_Stopped, KeyboardInterrupt) as stopped:
        if isinstance(stopped, KeyboardInterrupt):  # in the middle of an update, where no checkpoint can be taken
            run.save_policy()
        saved = checkpoint.newest(run.folder)
        raise TrainingStopped(run.folder, model.num_timesteps, checkpoint.step_of(saved) if saved else None) from None
    finally:
        display.close()
        run.curve.close()


@contextmanager
def _model(config: TrainingConfig) -> Iterator[PPO]:
    batch = make_batch(config.env, config.num_envs)
    try:
        env: VecEnv = batch
        if config.normalize_reward:
            env = VecNormalize(batch, norm_obs=False, gamma=config.ppo.gamma)
        yield make_model(config, env)
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


def _schedule(value: Any) -> Any:
    return LinearSchedule(value.start, value.end, end_fraction=1.0) if isinstance(value, Linear) else value


def _summary(values: dict[str, float]) -> str:
    """What the display shows of the last episodes, as far as the environment tells it."""
    shown = {name: form for name, form in _SUMMARY.items() if f"rollout/{name}" in values}
    return "  ".join(form.format(values[f"rollout/{name}"]) for name, form in shown.items())
