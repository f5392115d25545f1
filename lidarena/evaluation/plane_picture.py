"""Pictures of the plane: one per environment and one of all together."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.files import write_figure
from lidarena.evaluation.comparison_config import file_name
from lidarena.evaluation.palette import BLUE, GREEN, GREY, PINK, VERMILION
from lidarena.evaluation.plane import Plane, PlanePoint

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_AGENTS = (VERMILION, BLUE, GREEN, PINK)
_SHADE = "#E3E3E3"
_DPI = 120
_ROOM = 0.12
"""Around the points, of the span in logarithms, or as much as a factor of …"""
_LEAST_ROOM = np.log(1.15)
_STEPS = (
    (1, 1.5, 2, 3, 4, 5, 6, 8),
    (1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 6.5, 7, 8, 9),
    tuple(step / 20 for step in range(20, 200)),
)
"""Where a decade of an axis has ticks: the first that give `_FEW`."""
_FEW = 4
_AROUND = ((7, 5), (7, -13), (-7, 5), (-7, -13), (0, 9), (0, -17), (12, -4), (-12, -4))
"""Where a name may stand, from its point [points]; negative to the left."""


def draw_planes(planes: Sequence[Plane], whole: Plane | None, folder: Path) -> list[Path]:
    """Draw ``plane.png``, of all environments together if there are several, and ``planes/ENVIRONMENT.png``.

    Args:
        planes: Of the environments.
        whole: Of all together, if there is one.
        folder: Where the files go; it is made if there is anything to draw.

    Returns:
        The files, ``plane.png`` first.
    """
    if not planes:
        return []
    paths = [write_figure(folder / "plane.png", draw_plane(whole or planes[0]))]
    if len(planes) > 1:
        paths += [write_figure(folder / "planes" / f"{file_name(one.title)}.png", draw_plane(one)) for one in planes]
    return paths


def draw_plane(plane: Plane) -> "Figure":
    """Draw policies as points with their 95% intervals, agents as lines, and what the rules reach in grey."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 6.4), dpi=_DPI, layout="constrained")
    axes = figure.add_subplot()
    _scale(axes, plane)
    _shade(axes, plane)
    for point in plane.points:
        if not point.learned:
            _draw_point(axes, plane, point, GREY, "s")
    colours = _colours(plane)
    for name, line in plane.lines.items():
        _draw_line(axes, plane, name, line, colours[name])
    _explain(axes, plane)
    _write_names(figure, axes, plane)
    return figure


def _colours(plane: Plane) -> dict[str, str]:
    """Of the agents' lines."""
    return {name: _AGENTS[place % len(_AGENTS)] for place, name in enumerate(plane.lines)}


def _shown(plane: Plane, logs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Logarithms (…, 2) as the axes show them."""
    scales = [1.0, 1.0] if plane.relative_to is not None else [measure.scale for measure in plane.axes]
    return np.exp(logs) * scales


def _bounds(plane: Plane, point: PlanePoint) -> NDArray[np.float64]:
    """Value, lower and upper bound in logarithms, (3, 2); the value itself where there is no interval."""
    logs = np.log(point.values)
    return np.where(np.isfinite(logs), logs, point.logs)


def _scale(axes: "Axes", plane: Plane) -> None:
    """Logarithmic axes around all points, with ticks in plain numbers."""
    from matplotlib.ticker import FixedFormatter, FixedLocator, NullLocator

    logs = np.vstack([_bounds(plane, point) for point in plane.points])
    low, high = logs.min(axis=0), logs.max(axis=0)
    room = np.maximum(_ROOM * (high - low), _LEAST_ROOM)
    (left, bottom), (right, top) = _shown(plane, low - room), _shown(plane, high + room)
    axes.set(xscale="log", yscale="log", xlim=(left, right), ylim=(bottom, top))
    for axis, (begin, end) in ((axes.xaxis, (left, right)), (axes.yaxis, (bottom, top))):
        ticks = _ticks(begin, end)
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in ticks]))
        axis.set_minor_locator(NullLocator())
    axes.grid(alpha=0.25)


def _ticks(begin: float, end: float) -> list[float]:
    for steps in _STEPS:
        ticks = [tick for power in range(-9, 7) for step in steps if begin <= (tick := step * 10.0**power) <= end]
        if len(ticks) >= _FEW:
            break
    return ticks


def _shade(axes: "Axes", plane: Plane) -> None:
    """Shade what some rule, or two rules in turn, reach: up and right of the front."""
    front = np.array([point.logs for point in plane.front])
    if not len(front):
        return
    far = 50.0
    corners = np.vstack([[front[0, 0], far], front, [far, front[-1, 1]], [far, far]])
    axes.fill(*_shown(plane, corners).T, color=_SHADE, zorder=0, label="what the rules reach, and mixtures of them")
    edge = _shown(plane, corners[:-1])
    axes.plot(*edge.T, color=GREY, linewidth=1, linestyle=":", zorder=1)


def _draw_line(axes: "Axes", plane: Plane, name: str, line: Sequence[PlanePoint], colour: str) -> None:
    swept = ", ".join(line[0].entry.sweep)
    label = (
        f"{name}: one trained agent, its {swept} beside each point"
        if swept and len(line) > 1
        else f"{name}: a trained agent"
    )
    places = _shown(plane, np.array([point.logs for point in line]))
    axes.plot(*places.T, "-", color=colour, linewidth=2, zorder=3, label=label, marker="o", markersize=6)
    for point in line:
        _draw_point(axes, plane, point, colour, "o")


def _draw_point(axes: "Axes", plane: Plane, point: PlanePoint, colour: str, marker: str) -> None:
    (x, y), low, high = _shown(plane, _bounds(plane, point))
    errors: dict[str, Any] = {"xerr": [[x - low[0]], [high[0] - x]], "yerr": [[y - low[1]], [high[1] - y]]}
    face = colour if point.level else "white"
    axes.errorbar(
        [x], [y], **errors, fmt=marker, color=colour, markerfacecolor=face, markersize=6, linewidth=1, zorder=4
    )


def _explain(axes: "Axes", plane: Plane) -> None:
    across, up = plane.axes
    over = f" over that of {plane.relative_to}" if plane.relative_to is not None else ""
    labels = [f"{m.title}{over}" if over else m.label for m in (across, up)]
    hints = [f"\n({m.hint})" if m.hint else "" for m in (across, up)]
    axes.set_xlabel(f"{labels[0]}   ← better{hints[0]}")
    axes.set_ylabel(f"{labels[1]}   ← better{hints[1]}")
    count = f"{plane.episodes} episodes, the same for all" if plane.episodes > 1 else "one episode"
    known = any(np.isfinite(point.resampled).all() for point in plane.points)
    means = "; means with 95% intervals" if known else ""
    axes.set_title(f"{plane.title}: {count}{means}\nDown and to the left is better", fontsize=11)
    axes.plot([], [], "s", color=GREY, label="a rule, untrained")
    if not all(point.level for point in plane.points):
        axes.plot([], [], "s", color=GREY, markerfacecolor="white", label="explores less than the others")
    axes.figure.legend(loc="outside lower center", ncols=2, fontsize=8.5, frameon=False)


def _write_names(figure: "Figure", axes: "Axes", plane: Plane) -> None:
    """Write every name beside its point where it covers the fewest other names and points."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas: Any = FigureCanvasAgg(figure)
    renderer = canvas.get_renderer()
    figure.draw_without_rendering()
    places = [_shown(plane, point.logs) for point in plane.points]
    taken: list[Any] = []
    dots = axes.transData.transform(places)
    colours = _colours(plane)
    for point, place in zip(plane.points, places, strict=True):
        options = [_written(axes, point, place, offset, colours.get(point.line, "black")) for offset in _AROUND]
        boxes = [text.get_window_extent(renderer) for text in options]
        costs = [_crowding(box, taken, dots, axes.get_window_extent(renderer)) for box in boxes]
        best = int(np.argmin(costs))
        for number, text in enumerate(options):
            if number != best:
                text.remove()
        taken.append(boxes[best])


def _written(axes: "Axes", point: PlanePoint, place: NDArray[np.float64], offset: tuple[int, int], colour: str) -> Any:
    values = [str(value) for own in point.entry.sweep.values() for value in own]
    name = ", ".join(values) if point.learned and values else point.policy
    side = "left" if offset[0] > 0 else "right" if offset[0] < 0 else "center"
    where: dict[str, Any] = {"xytext": offset, "textcoords": "offset points", "ha": side}
    weight = "bold" if point.learned else "normal"
    return axes.annotate(name, tuple(place), **where, fontsize=9, fontweight=weight, color=colour, zorder=5)


def _crowding(box: Any, taken: Sequence[Any], dots: NDArray[np.float64], frame: Any) -> float:
    """How much a name would cover, and how far it would stick out of the frame."""
    padded = box.padded(2)
    covered = sum(padded.overlaps(other) for other in taken) + sum(padded.contains(*dot) for dot in dots)
    out = box.x0 < frame.x0 or box.x1 > frame.x1 or box.y0 < frame.y0 or box.y1 > frame.y1
    return float(covered + 2 * out)
