"""The picture of an arena: the potential with its minima, the plan and its forces, and what the robot does."""

from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.arena.known_way import way_ahead
from lidarena.envs.arena.potential_grid import PotentialGrid, survey
from lidarena.envs.path_recorder import PathRecorder
from lidarena.world.canvas import BLUE, GREEN, INK, MAGENTA, ORANGE, RED, WHITE, Canvas, Colour, write

if TYPE_CHECKING:
    from lidarena.envs.arena.state import ArenaCore

_SIDE = 560
"""Longer side of the panel [pixels]."""
_HEADER, _FOOTER = 44, 64
_LEVELS = 28
"""Contour lines."""
_ARROWS = 26
"""Forces drawn along the plan."""
_OBSTACLE = (238, 238, 240)


class ArenaRecorder:
    """Remembers what the picture draws: where the robots drove, their plans, and the potentials of their arenas.

    Args:
        worlds: Number of worlds.

    Attributes:
        driven: The robots' paths.
    """

    def __init__(self, worlds: int) -> None:
        self.driven = PathRecorder(worlds)
        self._potential_grids: list[PotentialGrid | None] = [None] * worlds
        self._plans: list[tuple[NDArray[np.float64], NDArray[np.float64] | None] | None] = [None] * worlds

    def begin(self, world: int, core: "ArenaCore") -> None:
        """Start one world's path anew."""
        self.driven.begin(world, core.physics.poses[world])
        self._potential_grids[world] = None
        self._plans[world] = None

    def show(self, world: int, plan: NDArray[np.float64], before: NDArray[np.float64] | None) -> None:
        """Draw a policy's plan, and what it was before it was smoothed, instead of the field's."""
        self._plans[world] = plan.copy(), None if before is None else before.copy()

    def plan(
        self, world: int, core: "ArenaCore", land: PotentialGrid
    ) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
        """What was shown last, else the way that the robot is shown, else, if obstacles are told, the field's plan."""
        shown = self._plans[world]
        if shown is not None:
            return shown
        if core.known is not None:
            return np.vstack([core.physics.poses[world, :, :2], way_ahead(world, core.known)]), None
        if core.options.knowledge == "lidar":
            return np.empty((0, 2)), None  # nobody here could have planned it
        return land.plan.smoothed, land.plan.path

    def potential_grid(self, world: int, core: "ArenaCore") -> PotentialGrid:
        """The potential of a world's arena, surveyed when it is first asked for."""
        found = self._potential_grids[world]
        if found is None:
            scenario = core.scenarios[world]
            assert scenario is not None
            found = self._potential_grids[world] = survey(scenario.arena, core.options.field)
        return found


def draw_arena(core: "ArenaCore", recorder: ArenaRecorder, world: int) -> NDArray[np.uint8]:
    """Draw one world, RGB (height, width, 3)."""
    scenario = core.scenarios[world]
    assert scenario is not None
    arena, land = scenario.arena, recorder.potential_grid(world, core)
    scale = _SIDE / max(arena.bounds[2] - arena.bounds[0], arena.bounds[3] - arena.bounds[1])
    canvas = Canvas(arena.bounds, scale)
    _draw_potential(canvas, land)
    if arena.plan is not None:
        for x1, y1, x2, y2 in arena.plan.edges:
            canvas.line(np.array([[x1, y1], [x2, y2]]), INK, 1)
    else:
        for x, y, radius in arena.circles:
            canvas.dots(np.array([[x, y]]), INK, radius * scale + 1.0)
            canvas.dots(np.array([[x, y]]), _OBSTACLE, radius * scale)
    for x, y, _, _, radius in core.moving.discs(world).tolist():
        canvas.dots(np.array([[x, y]]), MAGENTA, radius * scale)
    plan, before = recorder.plan(world, core, land)
    if before is not None:
        canvas.line(before, ORANGE, 2)
        _draw_forces(canvas, land, before)
    if len(plan):
        canvas.line(plan, BLUE, 2)
    canvas.line(recorder.driven.paths(world)[0], GREEN, 3)
    _draw_scan(canvas, core, world)
    _draw_places(canvas, land, np.array(arena.goal))
    canvas.robot(core.physics.poses[world, 0], float(core.radii[world]), GREEN)
    moves = bool(core.moving.number and core.moving.counts[world])
    return _framed(canvas.image, _headline(core, world, arena.name), core.options.field, moves)


def _draw_potential(canvas: Canvas, land: PotentialGrid) -> None:
    """Colours from low (dark) to high (bright) with contour lines; steep slopes at obstacles are cut off."""
    finite = land.potential[np.isfinite(land.potential)]
    low, high = float(finite.min()), float(np.quantile(finite, 0.97))
    height, width = canvas.image.shape[:2]
    shown = np.nan_to_num(np.sqrt(np.clip((land.potential - low) / max(high - low, 1e-12), 0.0, 1.0)), posinf=1.0)
    smooth = cv2.resize(shown.astype(np.float32)[::-1], (width, height), interpolation=cv2.INTER_LINEAR)
    colours = cv2.applyColorMap((255 * smooth).astype(np.uint8), cv2.COLORMAP_VIRIDIS)[:, :, ::-1]
    canvas.image[:] = colours // 2 + 110  # pale, so that what is drawn upon it stands out
    steps = np.floor(smooth * _LEVELS)
    edge = np.zeros(steps.shape, np.bool_)
    edge[:, 1:] |= steps[:, 1:] != steps[:, :-1]
    edge[1:] |= steps[1:] != steps[:-1]
    canvas.image[edge] = (canvas.image[edge] * 0.72).astype(np.uint8)


def _draw_forces(canvas: Canvas, land: PotentialGrid, path: NDArray[np.float64]) -> None:
    """Arrows of one length in the direction of the force, at points along the plan before regression search."""
    every = max(1, len(path) // _ARROWS)
    places = path[every // 2 :: every]
    force = land.field.force(places)
    size = np.hypot(force[:, 0], force[:, 1])
    length = 16.0 / canvas.scale
    for place, way, strength in zip(places, force, size, strict=True):
        if strength > 0.0:
            along = way / strength * length
            aside = np.array([-along[1], along[0]])
            tip = place + along
            canvas.line(np.array([place, tip]), INK, 1)
            canvas.line(np.array([tip - 0.35 * along + 0.22 * aside, tip, tip - 0.35 * along - 0.22 * aside]), INK, 1)


def _draw_scan(canvas: Canvas, core: "ArenaCore", world: int) -> None:
    scan = core.measurements.scans[world, 0].astype(np.float64)
    pose = core.physics.poses[world, 0]
    angles = core.beam.angles + pose[2]
    points = pose[:2] + scan[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    canvas.dots(points[(scan < core.beam.max_range) & (scan > 0.0)], RED, 2.4)


def _draw_places(canvas: Canvas, land: PotentialGrid, goal: NDArray[np.float64]) -> None:
    size = 7.0 / canvas.scale
    for x, y in land.minima:
        for sign in (1.0, -1.0):
            canvas.line(np.array([[x - size, y - sign * size], [x + size, y + sign * size]]), WHITE, 4)
        for sign in (1.0, -1.0):
            canvas.line(np.array([[x - size, y - sign * size], [x + size, y + sign * size]]), MAGENTA, 2)
    canvas.dots(goal[None], WHITE, 9.0)
    canvas.dots(goal[None], RED, 7.0)
    canvas.dots(goal[None], WHITE, 3.0)


def _headline(core: "ArenaCore", world: int, name: str) -> str:
    end = "   COLLISION" if core.physics.touched[world] else ""
    end = end or ("   GOAL REACHED" if core.measurements.distance[world] <= core.goal_radius else "")
    driven, left = core.measurements.path_length[world], core.measurements.distance[world]
    gap = core.measurements.gap[world]
    return f"{name}   driven {driven:.1f} m, {left:.1f} m to the goal, clearance {gap:.2f} m{end}"


def _framed(panel: NDArray[np.uint8], headline: str, field: str, moves: bool) -> NDArray[np.uint8]:
    height, width = panel.shape[:2]
    total = max(width + 16, 640)
    image = np.full((height + _HEADER + _FOOTER, total, 3), 255, np.uint8)
    left = (total - width) // 2
    image[_HEADER : _HEADER + height, left : left + width] = panel
    write(image, headline, 8, 17)
    write(image, f"potential of the field '{field}': dark is low, lines of equal potential", 8, 36, INK, 0.4)
    lines: list[list[tuple[str, Colour]]] = [
        [("driven", GREEN), ("lidar hits", RED), ("goal (ring)", RED), ("minimum of the potential (x)", MAGENTA)],
        [("plan, or way shown", BLUE), ("before regression search", ORANGE), ("force along that (arrows)", INK)],
    ]
    if moves:
        lines[1].append(("moves (disc)", MAGENTA))
    for row, words in enumerate(lines):
        column = 8
        for text, colour in words:
            column = write(image, text, column, height + _HEADER + 20 + 22 * row, colour) + 22
    return image
