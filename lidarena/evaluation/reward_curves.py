"""Reward curves: what trainings reached after how many steps, seeds of one kind as a line with a band.

python -m lidarena.evaluation.reward_curves "completeness=runs/a,runs/b,runs/c" "uncertainty=runs/d" --out curves.png
"""

import argparse
import csv
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lidarena.agents.learning_curve import FILE
from lidarena.base.errors import ConfigError, LidarenaError
from lidarena.base.files import check_writable, write_figure
from lidarena.base.terminal import make_output_printable
from lidarena.evaluation.palette import LINES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS = {"episode_return": "return of an episode", "completeness": "explored (%)", "collision_rate": "collisions (%)"}
"""Columns of ``progress.csv`` that are drawn, and what the axis says."""
_SHARES = ("completeness", "collision_rate")
_POINTS = 400
_DPI = 120


@dataclass(frozen=True)
class Trainings:
    """Trainings that differ in nothing but the seed.

    Attributes:
        label: In the legend.
        folders: Their run folders.
    """

    label: str
    folders: Sequence[Path]

    @classmethod
    def parse(cls, text: str) -> "Trainings":
        """Read ``LABEL=FOLDER,FOLDER`` or ``FOLDER``, whose name is then the label.

        Raises:
            ConfigError: There is no folder in it.
        """
        label, equals, rest = text.rpartition("=")
        folders = [Path(name) for name in rest.split(",") if name]
        if not folders or (equals and not label):
            raise ConfigError(f"{text!r} names no training; allowed is LABEL=FOLDER,FOLDER or FOLDER")
        return cls(label or folders[0].name, folders)


def read_curve(folder: Path, column: str) -> NDArray[np.float64]:
    """Rows (step, value) of one training's curve, those without a value left out; ``(n, 2)``.

    Raises:
        ConfigError: The folder holds no learning curve.
    """
    try:
        with (folder / FILE).open(encoding="utf-8", newline="") as stream:
            rows = [(float(row["step"]), float(row[column])) for row in csv.DictReader(stream) if row.get(column)]
    except OSError as error:
        raise ConfigError(f"{str(folder)!r} is no run folder: {FILE} cannot be read ({error.strerror})") from None
    except (KeyError, ValueError):
        raise ConfigError(f"{str(folder / FILE)!r} is no learning curve of a training, or is torn") from None
    return np.array(rows, dtype=np.float64).reshape(-1, 2)


def band(curves: Sequence[NDArray[np.float64]]) -> tuple[NDArray[np.float64], ...]:
    """Steps, mean, least and largest value over the trainings, as far as all of them have come."""
    begin, end = max(curve[0, 0] for curve in curves), min(curve[-1, 0] for curve in curves)
    steps = np.linspace(begin, end, _POINTS)
    values = np.array([np.interp(steps, curve[:, 0], curve[:, 1]) for curve in curves])
    return steps, values.mean(axis=0), values.min(axis=0), values.max(axis=0)


def draw_curves(trainings: Sequence[Trainings]) -> "Figure":
    """Draw a column of panels for every kind of training, since returns of different rewards share no axis.

    Raises:
        ConfigError: A folder holds no learning curve.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(max(4.6 * len(trainings), 5.5), 7.5), dpi=_DPI, layout="constrained")
    grid = figure.subplots(len(PANELS), len(trainings), squeeze=False, sharex="col")
    for place, kind in enumerate(trainings):
        colour = LINES[place % len(LINES)][0]
        for axes, (column, title) in zip(grid[:, place], PANELS.items(), strict=True):
            _draw(axes, kind, column, colour)
            if place == 0:
                axes.set_ylabel(title)
        seeds = len(kind.folders)
        grid[0, place].set_title(f"{kind.label}\n{seeds} seed{'s: mean and range' if seeds > 1 else ''}", fontsize=10)
        grid[-1, place].set_xlabel("steps of all worlds (millions)")
    return figure


def _draw(axes: "Axes", kind: Trainings, column: str, colour: str) -> None:
    curves = [curve for folder in kind.folders if len(curve := read_curve(folder, column))]
    axes.grid(alpha=0.3)
    if not curves:
        axes.text(0.5, 0.5, "not recorded", ha="center", transform=axes.transAxes)
        return
    steps, mean, low, high = band(curves)
    scale = 100.0 if column in _SHARES else 1.0
    axes.plot(steps / 1e6, scale * mean, color=colour)
    axes.fill_between(steps / 1e6, scale * low, scale * high, color=colour, alpha=0.25, linewidth=0)
    if column in _SHARES:
        axes.set_ylim(-2, 102)


def main(arguments: list[str] | None = None) -> int:
    """Draw the curves; return 0, or 2 for a refusal."""
    parser = argparse.ArgumentParser(prog="python -m lidarena.evaluation.reward_curves", description=__doc__)
    parser.add_argument("trainings", nargs="+", metavar="LABEL=FOLDER,FOLDER", help="trainings that differ by the seed")
    parser.add_argument("--out", default="reward_curves.png", help="picture to write (PNG)")
    make_output_printable()
    options = parser.parse_args(arguments)
    try:
        check_writable(options.out)
        write_figure(options.out, draw_curves([Trainings.parse(text) for text in options.trainings]))
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    print(f"picture:  {options.out}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
