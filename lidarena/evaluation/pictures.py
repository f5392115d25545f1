"""Pictures of a comparison: every policy's first episode, all of them side by side, and how a measure progressed."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lidarena.base.files import write_figure
from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import Episode
from lidarena.evaluation.palette import line_of
from lidarena.evaluation.picture import Bounds, Picture, axis_titles
from lidarena.evaluation.progress_curve import ProgressCurve, progress_band
from lidarena.evaluation.tasks import place_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARGIN = 0.03
"""Around what is drawn, of its larger side."""
PANEL = 3.4
DPI = 120
CURVE_POINTS = 300


@dataclass(frozen=True)
class Cell:
    """All episodes of one policy in one environment; the first one carries the picture."""

    env: EnvEntry
    policy: PolicyEntry
    episodes: Sequence[Episode]

    @property
    def picture(self) -> Picture | None:
        """Of the first episode."""
        return self.episodes[0].picture

    @property
    def whole(self) -> bool:
        """Whether all episodes that were driven have a curve."""
        return len(self.curves) == sum(episode.error is None for episode in self.episodes) > 0

    @property
    def curves(self) -> list[ProgressCurve]:
        """Of the episodes, as far as they have one."""
        return [episode.progress for episode in self.episodes if episode.progress is not None]


def draw_pictures(cells: Sequence[Sequence[Cell]], folder: Path) -> list[Path]:
    """Draw everything that can be drawn.

    Args:
        cells: ``cells[environment][policy]``.
        folder: Where the PNG files go; it is made if there is anything to draw.

    Returns:
        The files: ``overview.png`` and ``progress.png`` first, then ``ENVIRONMENT/POLICY.png``. None of an environment
        whose family draws nothing.
    """
    drawn = [row for row in cells if all(cell.picture is not None for cell in row)]
    curves = [row for row in cells if all(cell.whole for cell in row)]
    paths = []
    if drawn:
        paths.append(write_figure(folder / "overview.png", overview(drawn)))
    if curves:
        paths.append(write_figure(folder / "progress.png", progress(curves)))
    for row in drawn:
        for cell in row:
            paths.append(write_figure(folder / place_of(cell.env, cell.policy, "png"), single(cell)))
    return paths


def single(cell: Cell) -> "Figure":
    """Draw the first episode of a policy."""
    episode, box = cell.episodes[0], _box([cell])
    width, height = box[1] - box[0], box[3] - box[2]
    scale = 6.5 / max(width, height)
    figure = _figure(max(width * scale, 4.5) + 1.2, max(height * scale, 1.5) + 2.2)
    axes = figure.add_subplot()
    _draw(axes, cell, box)
    axes.set_title(f"{cell.policy.title} in {cell.env.label}, seed {episode.seed}\n{episode.caption}")
    across, up = axis_titles(cell.picture)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    _legend(figure, [axes])
    return figure


def overview(cells: Sequence[Sequence[Cell]]) -> "Figure":
    """Draw the first episodes side by side: a row per environment, a column per policy."""
    boxes = [_box(row) for row in cells]
    shapes = [(box[3] - box[2]) / (box[1] - box[0]) for box in boxes]
    heights = [PANEL * min(1.6, max(0.5, shape)) + 0.55 for shape in shapes]
    columns = len(cells[0])
    figure = _figure(max(PANEL * columns + 0.7, 6.5), sum(heights) + 1.4)
    grid = figure.subplots(len(cells), columns, squeeze=False, gridspec_kw={"height_ratios": heights})
    for row, box, line in zip(cells, boxes, grid, strict=True):
        for cell, axes in zip(row, line, strict=True):
            _draw(axes, cell, box)
            axes.set_title(cell.episodes[0].caption, fontsize=8.5)
        line[0].set_ylabel(f"{row[0].env.label}\n{axis_titles(row[0].picture)[1]}")
    for cell, top, bottom in zip(cells[0], grid[0], grid[-1], strict=True):
        header = {"xy": (0.5, 1), "xytext": (0, 20), "xycoords": "axes fraction", "textcoords": "offset points"}
        top.annotate(cell.policy.title, ha="center", fontsize=12, fontweight="bold", **header)
        bottom.set_xlabel(axis_titles(cell.picture)[0])
    # the layout does not see the annotated names of the policies: an empty second line leaves them room
    figure.suptitle(f"First episode of each policy (seed {cells[0][0].episodes[0].seed})\n", fontsize=12)
    _legend(figure, list(grid.ravel()))
    return figure


def progress(cells: Sequence[Sequence[Cell]]) -> "Figure":
    """Draw a measure over time: a panel per environment, mean and 95% bootstrap band over the episodes."""
    columns = min(3, len(cells))
    lines = -(-len(cells) // columns)
    figure = _figure(max(4.4 * columns, 5.5), 3.4 * lines + 0.4)
    grid = figure.subplots(lines, columns, squeeze=False).ravel()
    for axes in grid[len(cells) :]:
        axes.set_axis_off()
    for row, axes in zip(cells, grid, strict=False):
        _draw_progress(axes, row)
    grid[0].legend(fontsize=9, title="mean and 95% band", title_fontsize=8)
    return figure


def _draw_progress(axes: "Axes", row: Sequence[Cell]) -> None:
    measure = row[0].curves[0].measure
    end = max(float(curve.points[-1, 0]) for cell in row for curve in cell.curves)
    times = np.linspace(0.0, end, CURVE_POINTS)
    for index, cell in enumerate(row):
        mean, low, high = (measure.scale * values for values in progress_band(cell.curves, times))
        colour, dashes = line_of(index)
        axes.plot(times, mean, dashes, color=colour, label=cell.policy.title)
        axes.fill_between(times, low, high, color=colour, alpha=0.15, linewidth=0)
    count = len(row[0].episodes)
    axes.set_title(f"{row[0].env.label} ({count} {'episode' if count == 1 else 'episodes'} each)", fontsize=10)
    axes.set_xlabel("time (s)")
    axes.set_ylabel(measure.label)
    if measure.unit == "%":
        axes.set_ylim(0, 102)
    axes.set_xlim(0, max(end, 1e-9))
    axes.grid(alpha=0.3)


def _draw(axes: "Axes", cell: Cell, box: Bounds) -> None:
    assert cell.picture is not None
    cell.picture.draw(axes)
    axes.set_aspect("equal")
    axes.set_xlim(box[0], box[1])
    axes.set_ylim(box[2], box[3])


def _box(row: Sequence[Cell]) -> Bounds:
    """x_min, x_max, y_min, y_max around the pictures of an environment's policies."""
    bounds = np.array([cell.picture.bounds() for cell in row if cell.picture is not None])
    low, high = bounds.min(axis=0), bounds.max(axis=0)
    margin = MARGIN * max(high[1] - low[0], high[3] - low[2], 1e-3)
    return float(low[0] - margin), float(high[1] + margin), float(low[2] - margin), float(high[3] + margin)


def _legend(figure: "Figure", panels: Sequence["Axes"]) -> None:
    """One legend for all panels: each label once, as it is drawn where it comes first."""
    found = [pair for axes in panels for pair in zip(*axes.get_legend_handles_labels(), strict=True)]
    handles = {label: handle for handle, label in reversed(found)}
    labels = list(dict.fromkeys(label for _, label in found))
    width = figure.get_size_inches()[0]
    lines = -(-len(labels) // (9 if width > 12 else 5 if width > 7.5 else 3))
    columns = -(-len(labels) // max(lines, 1))
    where: dict[str, Any] = {"loc": "outside lower center", "ncols": columns, "fontsize": 8, "frameon": False}
    if labels:
        figure.legend(handles=[handles[label] for label in labels], labels=labels, **where)


def _figure(width: float, height: float) -> "Figure":
    """Return a figure that opens no window (pyplot is never imported)."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    # more room than by default: the layout does not see how far the axes' labels hang down into a legend
    return Figure(figsize=(width, height), dpi=DPI, layout=ConstrainedLayoutEngine(h_pad=0.07))
