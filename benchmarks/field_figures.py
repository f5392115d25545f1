"""The pictures of Yang et al.'s Figs. 2, 4 and 8, with the misprints corrected.

python benchmarks/field_figures.py [--out results/field_figures]
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from lidarena.base.errors import LidarenaError
from lidarena.base.files import check_writable, write_figure
from lidarena.base.terminal import make_output_printable
from lidarena.planning.potential_field.potential_field import PotentialField, plan_path
from lidarena.world.arenas import Arena, load_arena

FIG_4 = np.array([(29, 45, 0), (40, 45, 0), (65, 45, 0), (74, 74, 0)], dtype=np.float64)
FIELDS = {"traditional": "Khatib's field (eqs. 1, 3)", "paper": "improved field (eqs. 7, 8)"}


def figure_2(folder: Path) -> Path:
    """A goal at 0 beside an obstacle at 0.5 m: the minimum of the traditional potential lies off the goal."""
    figure = Figure(figsize=(7, 4.2), dpi=120, layout="constrained")
    axes = figure.add_subplot()
    x = np.linspace(-3.0, 0.42, 4001)
    for (preset, label), colour in zip(FIELDS.items(), ("#D55E00", "#0072B2"), strict=True):
        field = PotentialField.of([[0.5, 0.0, 0.0]], (-4.0, 0.0), (0.0, 0.0), preset, rho_0=1.5)
        values = field.potential(np.column_stack([x, np.zeros_like(x)]))
        lowest = int(np.argmin(values))
        axes.plot(x, values, color=colour, label=label)
        axes.plot(x[lowest], values[lowest], "o", color=colour, markeredgecolor="white", markersize=9)
        axes.annotate(
            f"minimum at x = {x[lowest]:.3f} m", (x[lowest], values[lowest]), (-6, -20 if preset == "paper" else 14),
            textcoords="offset points", ha="right", color=colour,
        )  # fmt: skip
    axes.axvline(0.5, color="black", linewidth=4)
    axes.text(0.47, 2.6, "obstacle", ha="right", rotation=90)
    axes.axvline(0.0, color="#009E73", linestyle="--")
    axes.text(0.02, 2.6, "goal", color="#009E73", rotation=90)
    axes.set(
        ylim=(-0.35, 3.5), xlabel="x (m)", ylabel="potential", title="Fig. 2: a goal that its neighbour keeps away"
    )
    axes.legend(loc="upper left", fontsize=9)
    return write_figure(folder / "fig2.png", figure)


def figure_4(folder: Path) -> Path:
    """The total potential in the 100 m room, traditional and improved."""
    figure = Figure(figsize=(11, 5), dpi=120, layout="constrained")
    for place, (preset, label) in enumerate(FIELDS.items(), start=1):
        axes = figure.add_subplot(1, 2, place)
        field = PotentialField.of(FIG_4, (0, 0), (70, 70), preset)
        _contours(figure, axes, field, (0.0, 0.0, 100.0, 100.0))
        axes.plot(FIG_4[:, 0], FIG_4[:, 1], "o", color="black", label="obstacle")
        axes.plot(70, 70, "*", color="#E69F00", markeredgecolor="black", markersize=15, label="goal")
        axes.set(title=f"Fig. 4: {label}", xlabel="x (m)", ylabel="y (m)", aspect="equal")
        axes.legend(loc="lower right", fontsize=9)
    return write_figure(folder / "fig4.png", figure)


def figure_8(folder: Path) -> Path:
    """The paths among the printed obstacles with both traps that the text leaves out."""
    figure = Figure(figsize=(11, 5.6), dpi=120, layout="constrained")
    for place, name in enumerate(("yang:arc", "yang:u"), start=1):
        arena = load_arena(name)
        axes = figure.add_subplot(1, 2, place)
        improved = plan_path(arena.circles, arena.start, arena.goal, "robust", 0.0, arena.bounds, ways=1)
        trapped = plan_path(arena.circles, arena.start, arena.goal, "traditional", 0.0, arena.bounds)
        field = PotentialField.after(improved, arena.circles, arena.start, arena.goal, 0.0, arena.bounds)
        _contours(figure, axes, field, arena.bounds)
        _circles(axes, arena)
        axes.plot(*trapped.path.T, color="#D55E00", linewidth=2.5, label="traditional field")
        axes.plot(*trapped.path[-1], "X", color="#D55E00", markeredgecolor="white", markersize=11, label="trapped")
        axes.plot(*improved.path.T, "--", color="black", linewidth=1.3, label="improved, before regression search")
        axes.plot(*improved.smoothed.T, color="#0072B2", linewidth=2.2, label="improved, after regression search")
        axes.plot(*arena.goal, "*", color="#E69F00", markeredgecolor="black", markersize=15, label="goal")
        axes.set(title=f"Fig. 8: {name}, {improved.fills} fills", xlabel="x (m)", ylabel="y (m)", aspect="equal")
        if place == 1:
            figure.legend(loc="outside lower center", ncols=5, fontsize=9)
    return write_figure(folder / "fig8.png", figure)


def _contours(figure: Figure, axes, field: PotentialField, bounds) -> None:  # type: ignore[no-untyped-def]
    x, y = np.linspace(bounds[0], bounds[2], 300), np.linspace(bounds[1], bounds[3], 300)
    potential: NDArray[np.float64] = field.potential(np.stack(np.meshgrid(x, y), axis=-1))
    top = float(np.quantile(potential[np.isfinite(potential)], 0.97))
    shown = np.minimum(np.nan_to_num(potential, posinf=top), top)
    filled = axes.contourf(x, y, shown, 24, cmap="viridis", alpha=0.75)
    axes.contour(x, y, shown, 24, colors="black", linewidths=0.3, alpha=0.6)
    figure.colorbar(filled, ax=axes, label="potential", shrink=0.85)


def _circles(axes, arena: Arena) -> None:  # type: ignore[no-untyped-def]
    from matplotlib.patches import Circle

    for x, y, radius in arena.circles:
        axes.add_patch(Circle((x, y), radius, facecolor="white", edgecolor="black", linewidth=0.8, zorder=2))


def main() -> int:
    """Draw all three; return 0, or 2 if they cannot be written."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default="results/field_figures", help="folder of the pictures")
    folder = Path(parser.parse_args().out)
    try:
        check_writable(folder / "figure")
        for draw in (figure_2, figure_4, figure_8):
            print(draw(folder))
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
