"""Pictures of a comparison: where every policy drove, all of them side by side, and how exploration progressed."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import Episode, Trace
from lidarena.evaluation.runner import place_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TRUE_COLOUR, ESTIMATE_COLOUR, WALL_COLOUR, GRAPH_COLOUR = "#0072B2", "#D55E00", "#7A5195", "#E69F00"
LINES = (("#0072B2", "-"), ("#D55E00", "--"), ("#009E73", "-."), ("#CC79A7", ":"), ("#E69F00", "-"), ("#555555", "--"))
"""Colours that the colour-blind can tell apart (Okabe and Ito), and dashes for those who print in grey."""

MARGIN = 0.3
PANEL = 3.4
DPI = 120
CURVE_POINTS = 300


@dataclass(frozen=True)
class Cell:
    """All episodes of one policy in one environment; the first one carries the trace."""

    env: EnvEntry
    policy: PolicyEntry
    episodes: Sequence[Episode]


def draw_pictures(cells: Sequence[Sequence[Cell]], folder: Path) -> list[Path]:
    """Draw everything that can be drawn.

    Args:
        cells: ``cells[environment][policy]``.
        folder: Where the PNG files go; it is made if there is anything to draw.

    Returns:
        The files: ``overview.png`` and ``progress.png`` first, then ``ENVIRONMENT/POLICY.png``. None where the
        environments give neither positions nor completeness.
    """
    traced = [row for row in cells if all(_trace(cell) is not None for cell in row)]
    paths = []
    if traced:
        paths.append(_save(overview(traced), folder / "overview.png"))
    curves = [row for row in cells if all(np.isfinite(cell.episodes[0].progress).all() for cell in row)]
    if curves:
        paths.append(_save(progress(curves), folder / "progress.png"))
    for row in traced:
        for cell in row:
            paths.append(_save(single(cell), folder / place_of(cell.env, cell.policy, "png")))
    return paths


def single(cell: Cell) -> "Figure":
    """Draw the first episode of a policy: walls, believed map, true and believed path."""
    trace = _trace(cell)
    assert trace is not None
    box = _box([trace])
    width, height = box[1] - box[0], box[3] - box[2]
    scale = 6.5 / max(width, height)
    figure = _figure(max(width * scale, 4.5) + 1.2, height * scale + 2.2)
    axes = figure.add_subplot()
    _draw_trace(axes, trace, cell.episodes[0], box)
    axes.set_title(
        f"{cell.policy.title} in {cell.env.label}, seed {cell.episodes[0].seed}\n{caption(cell.episodes[0])}"
    )
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    _legend(figure, axes, mapped=trace.grid is not None)
    return figure


def overview(cells: Sequence[Sequence[Cell]]) -> "Figure":
    """Draw the first episodes side by side: a row per environment, a column per policy."""
    boxes = [_box([trace for cell in row if (trace := _trace(cell)) is not None]) for row in cells]
    shapes = [(box[3] - box[2]) / (box[1] - box[0]) for box in boxes]
    heights = [PANEL * min(1.6, max(0.5, shape)) + 0.55 for shape in shapes]
    columns = len(cells[0])
    figure = _figure(max(PANEL * columns + 0.7, 6.5), sum(heights) + 1.4)
    grid = figure.subplots(len(cells), columns, squeeze=False, gridspec_kw={"height_ratios": heights})
    for row, box, line in zip(cells, boxes, grid, strict=True):
        for place, (cell, axes) in enumerate(zip(row, line, strict=True)):
            trace = _trace(cell)
            assert trace is not None
            _draw_trace(axes, trace, cell.episodes[0], box)
            axes.set_title(caption(cell.episodes[0]), fontsize=8.5)
            if row is cells[0]:
                header = {"xy": (0.5, 1), "xytext": (0, 20), "xycoords": "axes fraction", "textcoords": "offset points"}
                axes.annotate(cell.policy.title, ha="center", fontsize=12, fontweight="bold", **header)
            if place == 0:
                axes.set_ylabel(f"{cell.env.label}\ny (m)")
            if row is cells[-1]:
                axes.set_xlabel("x (m)")
    # the layout does not see the annotated names of the policies: an empty second line leaves them room
    figure.suptitle(f"First episode of each policy (seed {cells[0][0].episodes[0].seed})\n", fontsize=12)
    _legend(figure, *grid[0], mapped=any(trace.grid is not None for row in cells for trace in _traces(row)))
    return figure


def progress(cells: Sequence[Sequence[Cell]]) -> "Figure":
    """Draw how much was explored when: a panel per environment, mean and 95% bootstrap band over the episodes."""
    columns = min(3, len(cells))
    lines = -(-len(cells) // columns)
    figure = _figure(max(4.4 * columns, 5.5), 3.4 * lines + 0.4)
    grid = figure.subplots(lines, columns, squeeze=False).ravel()
    for axes in grid[len(cells) :]:
        axes.set_axis_off()
    for row, axes in zip(cells, grid, strict=False):
        end = max(float(episode.progress[-1, 0]) for cell in row for episode in cell.episodes)
        times = np.linspace(0.0, end, CURVE_POINTS)
        for index, cell in enumerate(row):
            mean, low, high = progress_band(cell.episodes, times)
            colour, dashes = LINES[index % len(LINES)]
            axes.plot(times, 100 * mean, dashes, color=colour, label=cell.policy.title)
            axes.fill_between(times, 100 * low, 100 * high, color=colour, alpha=0.15, linewidth=0)
        axes.set_title(f"{row[0].env.label} ({len(row[0].episodes)} episodes each)", fontsize=10)
        axes.set_xlabel("time (s)")
        axes.set_ylabel("explored (%)")
        axes.set_ylim(0, 102)
        axes.set_xlim(0, max(end, 1e-9))
        axes.grid(alpha=0.3)
    grid[0].legend(fontsize=9, title="mean and 95% band", title_fontsize=8)
    return figure


def progress_band(
    episodes: Sequence[Episode], times: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return mean completeness at some times, and its pointwise 95% percentile bootstrap band.

    An episode that has ended keeps the completeness that it ended with.

    Args:
        episodes: Of one policy in one environment.
        times: Ascending, shape (T,) [s].

    Returns:
        Mean, lower and upper bound, each of shape (T,).
    """
    places = [np.searchsorted(episode.progress[:, 0], times, side="right") - 1 for episode in episodes]
    curves = np.array([ep.progress[np.maximum(place, 0), 1] for ep, place in zip(episodes, places, strict=True)])
    rows = np.random.default_rng(0).integers(0, len(curves), (1000, len(curves)))
    weights = np.apply_along_axis(np.bincount, 1, rows, minlength=len(curves)) / len(curves)
    low, high = np.quantile(weights @ curves, [0.025, 0.975], axis=0)
    return curves.mean(axis=0), low, high


def caption(episode: Episode) -> str:
    """Return how an episode ended, such as ``"explored 97% in 31.2 m, 105 s: success"``."""
    value = episode.measures
    explored = value.get("completeness", np.nan)
    parts = [f"explored {100 * explored:.0f}%"] if np.isfinite(explored) else []
    if "arrival" in value:
        parts.append(f"{100 * value['arrival']:.0f}% of the robots arrived")
    if np.isfinite(value.get("path_ratio", np.nan)):
        parts.append(f"{value['path_ratio']:.2f} × A*'s path")
    lengths = [f"{value[name]:{form}}" for name, form in (("path_length", ".1f"), ("time", ".0f")) if name in value]
    units = [f"{text} {unit}" for text, unit in zip(lengths, ("m", "s"), strict=False) if text != "nan"]
    text = " in ".join([*parts, ", ".join(units)] if units else parts)
    return f"{text}: {episode.ending}" if text else episode.ending


def _traces(row: Sequence[Cell]) -> list[Trace]:
    """What is drawn of an environment's policies."""
    return [trace for cell in row if (trace := _trace(cell)) is not None]


def _trace(cell: Cell) -> Trace | None:
    trace = cell.episodes[0].trace
    return trace if trace is not None and len(trace.true) + len(trace.estimated) + len(trace.team) else None


def _draw_trace(axes: "Axes", trace: Trace, episode: Episode, box: tuple[float, float, float, float]) -> None:
    _draw_map(axes, trace)
    _draw_graph(axes, trace)
    if len(trace.team):
        _draw_team(axes, trace)
    else:
        _draw_robot(axes, trace, crash=episode.ending == "collision")
    axes.set_aspect("equal")
    axes.set_xlim(box[0], box[1])
    axes.set_ylim(box[2], box[3])


def _draw_robot(axes: "Axes", trace: Trace, crash: bool) -> None:
    for path, colour, dashes, label in (
        (trace.true, TRUE_COLOUR, "-", "true path"),
        (trace.estimated, ESTIMATE_COLOUR, (0, (4, 2)), "path as SLAM believes it"),
    ):
        if len(path):
            axes.plot(path[:, 0], path[:, 1], color=colour, linestyle=dashes, linewidth=1.4, label=label, zorder=4)
    path = trace.true if len(trace.true) else trace.estimated
    axes.plot(*path[0], "o", color="#009E73", markeredgecolor="white", markersize=9, label="start", zorder=5)
    if len(trace.goal):
        axes.plot(
            *trace.goal[0], "*", color="#E69F00", markeredgecolor="black", markersize=14, label="goal", zorder=4.5
        )
    _draw_end(axes, path[-1], crash)


def _draw_team(axes: "Axes", trace: Trace) -> None:
    """A colour a robot: its path, where it starts, where it is to go, and where it ended."""
    for robot, goal in enumerate(trace.goal):
        path, colour = trace.team[:, robot], LINES[robot % len(LINES)][0]
        label = ("path, a colour a robot", "start", "goal") if robot == 0 else (None, None, None)
        axes.plot(*path.T, color=colour, linewidth=1.4, label=label[0], zorder=4)
        axes.plot(*path[0], "o", color=colour, markeredgecolor="white", markersize=8, label=label[1], zorder=5)
        axes.plot(*goal, "*", color=colour, markeredgecolor="black", markersize=14, label=label[2], zorder=4.5)
        _draw_end(axes, path[-1], bool(trace.collided[robot]))


def _draw_end(axes: "Axes", place: NDArray[np.float64], crash: bool) -> None:
    shape, colour = ("X", "#CC0000") if crash else ("s", "black")
    size = 9 if crash else 6
    axes.plot(*place, shape, color=colour, markeredgecolor="white", markersize=size, label="end", zorder=5)


def _draw_graph(axes: "Axes", trace: Trace) -> None:
    from matplotlib.collections import LineCollection

    if len(trace.nodes):
        joints = [(tuple(trace.nodes[i]), tuple(trace.nodes[j])) for i, j in trace.links]
        axes.add_collection(LineCollection(joints, colors=GRAPH_COLOUR, linewidths=2.5, alpha=0.6, zorder=3))
        style: dict[str, Any] = {"markersize": 6, "markeredgecolor": "white", "zorder": 4.5}
        axes.plot(*trace.nodes.T, "o", color=GRAPH_COLOUR, label="topological graph", linestyle="", **style)


def _draw_map(axes: "Axes", trace: Trace) -> None:
    from matplotlib.collections import LineCollection
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Circle

    if trace.grid is not None:
        axes.set_facecolor("#C9CDD2")  # as unknown cells: what lies beyond the grid is unknown too
        (x, y), (rows, columns) = trace.origin, trace.grid.shape
        extent = (x, x + columns * trace.resolution, y, y + rows * trace.resolution)
        colours = ListedColormap(["#C9CDD2", "#FFFFFF", "#222222"])
        norm = BoundaryNorm([-1.5, -0.5, 50.0, 101.0], 3)
        axes.imshow(trace.grid, origin="lower", extent=extent, cmap=colours, norm=norm, interpolation="nearest")
    walls = [((x1, y1), (x2, y2)) for x1, y1, x2, y2 in trace.edges]
    axes.add_collection(LineCollection(walls, colors=WALL_COLOUR, linewidths=0.7, zorder=3))
    for x, y, radius in trace.circles:
        axes.add_patch(Circle((x, y), radius, fill=False, edgecolor=WALL_COLOUR, linewidth=0.7, zorder=3))


def _box(traces: Sequence[Trace]) -> tuple[float, float, float, float]:
    """Return x_min, x_max, y_min, y_max around walls, paths and known cells."""
    points = [
        np.vstack([trace.true, trace.estimated, trace.team.reshape(-1, 2), trace.edges.reshape(-1, 2)])
        for trace in traces
    ]
    for trace in traces:
        if trace.grid is not None and not len(trace.edges):
            rows, columns = np.nonzero(trace.grid >= 0)
            points.append(trace.origin + trace.resolution * np.column_stack([columns, rows]))
            points.append(trace.origin + trace.resolution * np.column_stack([columns + 1, rows + 1]))
    low, high = np.vstack(points).min(axis=0) - MARGIN, np.vstack(points).max(axis=0) + MARGIN
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def _legend(figure: "Figure", *panels: "Axes", mapped: bool = True) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    known = [
        Patch(facecolor="#C9CDD2", edgecolor="#888888", label="unknown to the robot"),
        Patch(facecolor="white", edgecolor="#888888", label="mapped as free"),
        Patch(facecolor="#222222", label="mapped as wall"),
        Line2D([], [], color=WALL_COLOUR, linewidth=0.9, label="true walls"),
    ]
    known = known if mapped else known[-1:]
    drawn = {handle.get_label(): handle for axes in panels for handle in axes.get_legend_handles_labels()[0]}
    lines = [handle for label, handle in drawn.items() if label != "end"]
    ends = [_marker("black", "s", "end"), _marker("#CC0000", "X", "collision")]
    width = figure.get_size_inches()[0]
    columns = 9 if width > 12 else 5 if width > 7.5 else 3
    figure.legend(handles=[*known, *lines, *ends], loc="outside lower center", ncols=columns, fontsize=8, frameon=False)


def _marker(colour: str, shape: str, label: str) -> Any:
    from matplotlib.lines import Line2D

    return Line2D([], [], color=colour, marker=shape, markeredgecolor="white", markersize=9, linestyle="", label=label)


def _figure(width: float, height: float) -> "Figure":
    """Return a figure that no window system hears of (pyplot is never imported)."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    # more room than by default: the layout does not see how far the axes' labels hang down into a legend
    return Figure(figsize=(width, height), dpi=DPI, layout=ConstrainedLayoutEngine(h_pad=0.07))


def _save(figure: "Figure", path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)  # a bare Figure renders PNG with Agg
    return path
