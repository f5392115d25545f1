"""Pictures of drives on a floor plan: walls, the believed map, where robots went and where they were to go."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.evaluation.palette import AMBER, BLUE, GREEN, LINES, RED, VERMILION, VIOLET
from lidarena.evaluation.picture import Bounds, bounds_around

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
_UNKNOWN = "#C9CDD2"


def _no_rows(columns: int) -> Callable[[], Floats]:
    return lambda: np.empty((0, columns))


@dataclass(frozen=True)
class Walls:
    """What is solid.

    Attributes:
        edges: x1, y1, x2, y2 of walls, shape (E, 4) [m].
        circles: x, y, radius of pillars, shape (C, 3) [m].
        label: In the legend.
        filled: Whether pillars are shaded.
    """

    edges: Floats = field(default_factory=_no_rows(4))
    circles: Floats = field(default_factory=_no_rows(3))
    label: str = "true walls"
    filled: bool = False

    @classmethod
    def of(cls, env: Any, label: str = "true walls", filled: bool = False) -> "Walls":
        """Those of the ``floorplan`` of an environment; none if it has none."""
        plan = getattr(env.unwrapped, "floorplan", None)
        return cls() if plan is None else cls(np.array(plan.edges), np.array(plan.circles), label, filled)

    def corners(self) -> Floats:
        """Points around everything, (n, 2) [m]."""
        low, high = self.circles[:, :2] - self.circles[:, 2:], self.circles[:, :2] + self.circles[:, 2:]
        return np.vstack([self.edges.reshape(-1, 2), low, high])

    def draw(self, axes: "Axes") -> None:
        """Draw the outlines."""
        from matplotlib.collections import LineCollection
        from matplotlib.colors import to_rgb
        from matplotlib.patches import Circle

        lines = [((x1, y1), (x2, y2)) for x1, y1, x2, y2 in self.edges]
        axes.add_collection(LineCollection(lines, colors=VIOLET, linewidths=0.7, zorder=3))
        for x, y, radius in self.circles:
            shade = (*to_rgb(VIOLET), 0.25 if self.filled else 0.0)
            axes.add_patch(Circle((x, y), radius, facecolor=shade, edgecolor=VIOLET, linewidth=0.7, zorder=3))
        if self.filled and len(self.circles):
            axes.scatter([], [], s=70, color=(*to_rgb(VIOLET), 0.25), edgecolor=VIOLET, label=self.label)
        elif len(self.edges) + len(self.circles):
            axes.plot([], [], color=VIOLET, linewidth=0.9, label=self.label)


@dataclass(frozen=True)
class BelievedMap:
    """An occupancy grid.

    Attributes:
        cells: Shape (rows, columns), -1 unknown, 0 free … 100 occupied.
        resolution: Side of a cell [m].
        origin: Lower-left corner of cell [0, 0], shape (2,) [m].
    """

    cells: NDArray[np.int8]
    resolution: float
    origin: Floats

    def corners(self) -> Floats:
        """Points around what is known, (n, 2) [m]."""
        places = np.argwhere(self.cells >= 0)[:, ::-1]
        ends = np.array([places.min(axis=0), places.max(axis=0) + 1]) if len(places) else np.zeros((0, 2))
        return np.asarray(self.origin + self.resolution * ends)

    def draw(self, axes: "Axes") -> None:
        """Draw the cells: unknown grey, free white, occupied black."""
        from matplotlib.colors import BoundaryNorm, ListedColormap

        axes.set_facecolor(_UNKNOWN)  # what lies beyond the grid is unknown too
        (x, y), (rows, columns) = self.origin, self.cells.shape
        extent = (x, x + columns * self.resolution, y, y + rows * self.resolution)
        colours = (_UNKNOWN, "#FFFFFF", "#222222")
        norm = BoundaryNorm([-1.5, -0.5, 50.0, 101.0], 3)
        axes.imshow(
            self.cells, origin="lower", extent=extent, cmap=ListedColormap(colours), norm=norm, interpolation="nearest"
        )
        for colour, label in zip(colours, ("unknown to the robot", "mapped as free", "mapped as wall"), strict=True):
            axes.scatter([], [], s=70, marker="s", color=colour, edgecolor="#888888", label=label)


@dataclass(frozen=True)
class RobotTrace:
    """Where one robot went and what it believed; a ``Picture``.

    Attributes:
        true: Positions, shape (T + 1, 2) [m]; empty (0, 2) if the environment does not expose the truth.
        estimated: Positions that SLAM believed, shape (T + 1, 2) [m]; empty where the pose is known.
        walls: Of the floor plan.
        belief: The map at the end; None if there is none.
        nodes: Nodes of the policy's own graph of the world, shape (V, 2) [m]; empty if it keeps none.
        links: Which of them it has joined, shape (L, 2).
        goal: Where the robot is to go, shape (1, 2) [m]; empty if it has no goal.
        crashed: Whether the drive ended in a collision.
    """

    true: Floats
    estimated: Floats = field(default_factory=_no_rows(2))
    walls: Walls = field(default_factory=Walls)
    belief: BelievedMap | None = None
    nodes: Floats = field(default_factory=_no_rows(2))
    links: NDArray[np.int64] = field(default_factory=lambda: np.empty((0, 2), np.int64))
    goal: Floats = field(default_factory=_no_rows(2))
    crashed: bool = False

    def bounds(self) -> Bounds:
        """Around walls, paths and goal; without walls, also around the known cells."""
        walls = self.walls.corners()
        known = self.belief.corners() if self.belief is not None and not len(walls) else np.empty((0, 2))
        return bounds_around([self.true, self.estimated, self.goal, walls, known])

    def draw(self, axes: "Axes") -> None:
        """Draw map, walls, the policy's graph, and true and believed path."""
        if self.belief is not None:
            self.belief.draw(axes)
        self.walls.draw(axes)
        self._draw_graph(axes)
        for path, colour, dashes, label in (
            (self.true, BLUE, "-", "true path" if len(self.estimated) else "path"),
            (self.estimated, VERMILION, (0, (4, 2)), "path as SLAM believes it"),
        ):
            if len(path):
                axes.plot(path[:, 0], path[:, 1], color=colour, linestyle=dashes, linewidth=1.4, label=label, zorder=4)
        path = self.true if len(self.true) else self.estimated
        axes.plot(*path[0], "o", color=GREEN, markeredgecolor="white", markersize=9, label="start", zorder=5)
        if len(self.goal):
            axes.plot(*self.goal[0], "*", color=AMBER, markeredgecolor="black", markersize=14, label="goal", zorder=5.5)
        draw_end(axes, path[-1], self.crashed)
        explain_ends(axes)

    def _draw_graph(self, axes: "Axes") -> None:
        from matplotlib.collections import LineCollection

        if len(self.nodes):
            joints = [(tuple(self.nodes[i]), tuple(self.nodes[j])) for i, j in self.links]
            axes.add_collection(LineCollection(joints, colors=AMBER, linewidths=2.5, alpha=0.6, zorder=3))
            style: dict[str, Any] = {"markersize": 6, "markeredgecolor": "white", "zorder": 4.5}
            axes.plot(*self.nodes.T, "o", color=AMBER, label="topological graph", linestyle="", **style)


@dataclass(frozen=True)
class TeamTrace:
    """Where the robots of a team went; a ``Picture``.

    Attributes:
        paths: Positions, shape (T + 1, robots, 2) [m].
        goals: Where each is to go, shape (robots, 2) [m].
        collided: Which of them touched something, shape (robots,).
        walls: Of the floor plan.
    """

    paths: Floats
    goals: Floats
    collided: NDArray[np.bool_]
    walls: Walls = field(default_factory=Walls)

    def bounds(self) -> Bounds:
        """Around walls, paths and goals."""
        return bounds_around([self.paths, self.goals, self.walls.corners()])

    def draw(self, axes: "Axes") -> None:
        """Draw the walls, and in a colour a robot its path, where it starts, where it is to go, where it ended."""
        self.walls.draw(axes)
        for robot, goal in enumerate(self.goals):
            path, colour = self.paths[:, robot], LINES[robot % len(LINES)][0]
            label = ("path, one colour per robot", "start", "goal") if robot == 0 else (None, None, None)
            axes.plot(*path.T, color=colour, linewidth=1.4, label=label[0], zorder=4)
            axes.plot(*path[0], "o", color=colour, markeredgecolor="white", markersize=8, label=label[1], zorder=5)
            axes.plot(*goal, "*", color=colour, markeredgecolor="black", markersize=14, label=label[2], zorder=5.5)
            draw_end(axes, path[-1], bool(self.collided[robot]))
        explain_ends(axes)


_END: dict[str, Any] = {"marker": "s", "color": "black", "markersize": 6, "markeredgecolor": "white"}
_CRASH: dict[str, Any] = {"marker": "X", "color": RED, "markersize": 9, "markeredgecolor": "white"}


def draw_end(axes: "Axes", place: Floats, crash: bool) -> None:
    """Mark where a path ended, and how."""
    axes.plot(*place, linestyle="", zorder=5, **(_CRASH if crash else _END))


def explain_ends(axes: "Axes") -> None:
    """Explain the marks of ``draw_end`` in the legend."""
    for style, label in ((_END, "end"), (_CRASH, "collision")):
        axes.plot([], [], linestyle="", label=label, **style)
