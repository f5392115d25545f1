"""A training in its folder: what happens between two updates, and how it ends."""

import time
from contextlib import suppress
from pathlib import Path

import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import Logger

from lidarena.agents import checkpoint, run_folder
from lidarena.agents.interruption import StopRequest, TrainingStopped, stop_on_signal
from lidarena.agents.learner_config import BLOCKS, OffPolicyConfig
from lidarena.agents.learning_curve import LearningCurve
from lidarena.agents.network_weights import all_finite, weights_of
from lidarena.agents.policy_file import save_policy
from lidarena.agents.progress import ProgressDisplay, show_progress
from lidarena.agents.trainer_state import batch_of
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError

_ROW_EVERY = 2_000
"""Steps between two rows of the curve where updates come too often for one each: with a memory of transitions."""

_EPISODE_MEANS = {
    "r": "ep_rew_mean",
    "l": "ep_len_mean",
    "completeness": "completeness",
    "success": "success_rate",
    "is_success": "success_rate",
    "collision": "collision_rate",
    "path_length": "path_length",
    "time": "episode_time",
}
"""What an ended episode tells, and what its mean is called."""
_SUMMARY = {"ep_rew_mean": "return {:.1f}", "completeness": "completeness {:.0%}", "success_rate": "success {:.0%}"}
_SUMMARY |= {"collision_rate": "collisions {:.0%}"}


class _Stopped(Exception):  # noqa: N818  not an error: it carries the wish to stop out of Stable-Baselines3's loop
    pass


class TrainingRun:
    """A training in its folder: what happens between two updates.

    Args:
        config: What is trained.
        folder: Run folder.
        model: The learner, new or restored.
        seconds: That the training took before it was interrupted [s].
    """

    def __init__(self, config: TrainingConfig, folder: Path, model: BaseAlgorithm, seconds: float) -> None:
        self.config, self.folder, self.model = config, folder, model
        self.curve = LearningCurve(folder, after=model.num_timesteps)
        self._saved_at = self._row_at = model.num_timesteps
        self._seconds, self._row_seconds = seconds, seconds
        self._began = time.perf_counter()

    @property
    def seconds(self) -> float:
        """Seconds of training, those before a resumption included."""
        return self._seconds + time.perf_counter() - self._began

    def is_due(self, last: bool) -> bool:
        """Whether anything is to be written after this update."""
        step = self.model.num_timesteps
        rare = isinstance(self.config.learner, OffPolicyConfig)
        return last or not rare or step // _ROW_EVERY > self._row_at // _ROW_EVERY or self._checkpoint_is_due()

    def _checkpoint_is_due(self) -> bool:
        every = self.config.checkpoint_every
        return self.model.num_timesteps // every > self._saved_at // every

    def end_update(self, last: bool) -> str:
        """Write the row of the learning curve and, if due, the policy and a checkpoint.

        Returns:
            How good the agent is by now, in words.
        """
        step = self.model.num_timesteps
        if not all_finite(weights_of(self.model.policy)):
            key, rate = f"{BLOCKS[self.config.algorithm]}.learning_rate", self.config.learner.learning_rate
            raise ConfigError(
                f"the training has failed at step {step:,}: the weights are no longer finite numbers; "
                f"try a smaller {key} than {rate}, or normalize_reward: true"
            )
        values = self._values(step)
        self.curve.add(step, self.seconds, values)
        self._row_at, self._row_seconds = step, self.seconds
        if last or self._checkpoint_is_due():
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
            "algorithm": config.algorithm,
            "steps": self.model.num_timesteps,
            "total_steps": config.total_steps,
            "seed": config.seed,
            "num_envs": config.num_envs,
            "episodes": batch_of(self.model).episodes,
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
        values["rollout/episodes"] = batch_of(self.model).episodes
        values["time/steps_per_second"] = (step - self._row_at) / max(self.seconds - self._row_seconds, 1e-9)
        return values


class _BetweenUpdates(BaseCallback):
    """Calls the run at the start of every rollout, which is the end of an update, and moves the display."""

    def __init__(self, run: TrainingRun, display: ProgressDisplay, stop: StopRequest) -> None:
        super().__init__()
        self._run, self._display, self._stop = run, display, stop
        self._first = True

    def _on_rollout_start(self) -> None:
        if not self._first and self._run.is_due(last=self._stop.requested):
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


def learn(run: TrainingRun, progress: bool) -> None:
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
            with suppress(KeyboardInterrupt):  # pressed once more; the files are whole in any case
                run.save_policy()
        saved = checkpoint.newest(run.folder)
        raise TrainingStopped(run.folder, model.num_timesteps, checkpoint.step_of(saved) if saved else None) from None
    finally:
        display.close()
        run.curve.close()


def _summary(values: dict[str, float]) -> str:
    """What the display shows of the last episodes, as far as the environment tells it."""
    shown = {name: form for name, form in _SUMMARY.items() if f"rollout/{name}" in values}
    return "  ".join(form.format(values[f"rollout/{name}"]) for name, form in shown.items())
