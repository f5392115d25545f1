"""The learning curve of a run: one row an update, in ``progress.csv`` and as TensorBoard events."""

import csv
import io
import math
from collections.abc import Mapping
from pathlib import Path

from lidarena.base.files import write_text

FILE = "progress.csv"

COLUMNS: dict[str, tuple[str, ...]] = {
    "step": (),
    "seconds": (),
    "steps_per_second": ("time/steps_per_second",),
    "episodes": ("rollout/episodes",),
    "episode_return": ("rollout/ep_rew_mean",),
    "episode_length": ("rollout/ep_len_mean",),
    "completeness": ("rollout/completeness",),
    "success_rate": ("rollout/success_rate",),
    "collision_rate": ("rollout/collision_rate",),
    "learning_rate": ("train/learning_rate",),
    "policy_loss": ("train/policy_gradient_loss", "train/actor_loss"),
    "value_loss": ("train/value_loss", "train/critic_loss", "train/loss"),
    "entropy_loss": ("train/entropy_loss",),
    "approx_kl": ("train/approx_kl",),
    "clip_fraction": ("train/clip_fraction",),
    "explained_variance": ("train/explained_variance",),
}
"""Columns of ``progress.csv`` and the names of the same in TensorBoard, the first that a learner tells.

``episode_return`` (undiscounted), ``episode_length`` (steps), ``completeness`` (fraction at the end), ``success_rate``
and ``collision_rate`` (fractions) are means over the last episodes (``stats_window_size`` of the
learner's block), empty while there is none or where the environment does not tell them. Losses and the like are empty
where a learner has none. ``seconds`` is the time that the training has taken, pauses before a ``--resume`` left out.
"""


class LearningCurve:
    """Writer of the learning curve; a row is on the disk when `add` returns."""

    def __init__(self, folder: Path, after: int = 0) -> None:
        """Open the curve of a run.

        Args:
            folder: Run folder.
            after: Step from which the training goes on: rows of later steps, which it takes again, are dropped.
        """
        from torch.utils.tensorboard import SummaryWriter

        self._file = folder / FILE
        self._cut(after)
        self._events = SummaryWriter(str(folder), purge_step=after + 1 if after else None)

    def add(self, step: int, seconds: float, values: Mapping[str, float]) -> None:
        """Write one row.

        Args:
            step: Steps of all worlds so far.
            seconds: Of training so far.
            values: By TensorBoard's names; those without a column go to TensorBoard only.
        """
        known = {
            column: next((values[name] for name in names if name in values), None) for column, names in COLUMNS.items()
        }
        row = {**known, "step": step, "seconds": round(seconds, 3)}
        with self._file.open("a", encoding="utf-8", newline="") as stream:
            csv.DictWriter(stream, COLUMNS, lineterminator="\n").writerow(
                {column: _text(value) for column, value in row.items()}
            )
        for name, value in values.items():
            if math.isfinite(value):
                self._events.add_scalar(name, value, step)
        self._events.flush()

    def close(self) -> None:
        """Close the TensorBoard file."""
        self._events.close()

    def _cut(self, after: int) -> None:
        rows = []
        if self._file.exists():
            with self._file.open(encoding="utf-8", newline="") as stream:
                rows = [row for row in csv.DictReader(stream) if _step(row) <= after]
        text = io.StringIO()
        writer = csv.DictWriter(text, COLUMNS, lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
        write_text(self._file, text.getvalue())


def _text(value: float | None) -> str:
    return (
        "" if value is None or not math.isfinite(value) else f"{value:.9g}" if isinstance(value, float) else str(value)
    )


def _step(row: Mapping[str, str | None]) -> float:
    """The step of a row; a row that a crash has torn counts as later than any."""
    if None in row.values():
        return math.inf
    try:
        return int(row.get("step") or "")
    except ValueError:
        return math.inf
