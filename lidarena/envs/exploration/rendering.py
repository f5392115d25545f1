"""The picture of an exploration world: the truth on the left, what the filter believes on the right."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.exploration.state import RESOLUTION, ExplorationCore
from lidarena.envs.path_recorder import PathRecorder
from lidarena.world.canvas import (
    BLUE,
    GREEN,
    INK,
    MAGENTA,
    ORANGE,
    RED,
    WHITE,
    Canvas,
    Colour,
    draw_floorplan,
    write,
)

_PANEL = 470
"""Longer side of a panel [pixels]."""
_HEADER = 40
_FOOTER = 26
_GAP = 10
_UNKNOWN = (205, 208, 214)
_WALL = (30, 30, 36)


def path_points(core: ExplorationCore) -> NDArray[np.float64]:
    """(worlds, 3, 2) where every robot is, believes to be, and is by its wheels alone [m]."""
    return np.stack([core.physics.poses[:, 0, :2], core.estimate[:, :2], core.sensors.dead_reckoning[:, 0, :2]], axis=1)


def draw_exploration(
    core: ExplorationCore,
    recorder: PathRecorder,
    world: int,
    more: Callable[[Canvas], None] = lambda belief: None,
    legend: Sequence[tuple[str, Colour]] = (),
) -> NDArray[np.uint8]:
    """Draw one world, RGB (height, width, 3).

    Args:
        core: The worlds.
        recorder: Of ``path_points``.
        world: Which.
        more: Draws what else there is to show over the belief.
        legend: Words for that and their colours.
    """
    plan = core.plans[int(core.plan[world])]
    low_x, low_y, high_x, high_y = plan.bounds
    bounds = (low_x - 0.2, low_y - 0.2, high_x + 0.2, high_y + 0.2)
    scale = _PANEL / max(bounds[2] - bounds[0], bounds[3] - bounds[1])
    truth, belief = Canvas(bounds, scale), Canvas(bounds, scale)
    true_path, believed_path, reckoned_path = recorder.paths(world)
    draw_floorplan(truth, plan)
    truth.line(true_path, GREEN)
    _draw_scan(truth, core, world, core.physics.poses[world, 0])
    truth.robot(core.physics.poses[world, 0], core.robot.radius, GREEN)
    truth.scale_bar()
    _draw_map(belief, core, world)
    belief.line(reckoned_path, ORANGE, 1)
    belief.line(believed_path, BLUE)
    _draw_scan(belief, core, world, core.estimate[world])
    _draw_belief(belief, core, world)
    more(belief)
    return _compose(truth.image, belief.image, _headline(core, world, plan.name), legend)


def _draw_scan(canvas: Canvas, core: ExplorationCore, world: int, pose: NDArray[np.float64]) -> None:
    scan = core.sensors.scans[world, 0].astype(np.float64)
    hit = (scan < core.beam.max_range) & (scan > 0.0)
    angles = core.beam.angles + pose[2]
    points = pose[:2] + scan[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    canvas.dots(points[hit], RED, 1.3)


def _draw_map(canvas: Canvas, core: ExplorationCore, world: int) -> None:
    occupancy = core.maps.occupancy[world]
    colours = np.full((*occupancy.shape, 3), _UNKNOWN, np.uint8)
    colours[occupancy == 0] = WHITE
    colours[occupancy == 100] = _WALL
    canvas.image[:] = _UNKNOWN
    canvas.cells(colours, core.maps.origin[world], RESOLUTION)


def _draw_belief(canvas: Canvas, core: ExplorationCore, world: int) -> None:
    estimate = core.estimate[world]
    canvas.robot(estimate, core.robot.radius, BLUE)
    if core.estimator.particles is not None:
        canvas.dots(core.estimator.particles[world, :, :2], MAGENTA, 1.5)
    canvas.ellipse(estimate[:2], core.covariance[world, :2, :2], MAGENTA)


def _headline(core: ExplorationCore, world: int, name: str) -> str:
    particles = core.estimator.infos().get("n_eff")
    n_eff = "" if particles is None else f"   N_eff {particles[world]:.0f}"
    path = core.sensors.path_length[world]
    return (
        f"{name}   completeness {100 * core.completeness[world]:.1f} %   path {path:.1f} m   "
        f"D-opt {core.d_optimality[world]:.1e}{n_eff}{'   COLLISION' if core.sensors.collision[world] else ''}"
    )


def _compose(
    left: NDArray[np.uint8], right: NDArray[np.uint8], headline: str, legend: Sequence[tuple[str, Colour]]
) -> NDArray[np.uint8]:
    height, width = left.shape[:2]
    total = max(2 * width + 3 * _GAP, 640)
    image = np.full((height + _HEADER + _FOOTER, total, 3), 255, np.uint8)
    margin = (total - 2 * width - _GAP) // 2
    image[_HEADER : _HEADER + height, margin : margin + width] = left
    image[_HEADER : _HEADER + height, margin + width + _GAP : margin + 2 * width + _GAP] = right
    write(image, headline, 8, 15)
    write(image, "truth", margin, 34, INK, 0.45)
    write(image, "what the filter believes", margin + width + _GAP, 34, INK, 0.45)
    words: list[tuple[str, Colour]] = [
        ("true path", GREEN), ("scan", RED), ("estimated path", BLUE), ("odometry alone", ORANGE),
        ("particles, 2-sigma", MAGENTA), *legend,
    ]  # fmt: skip
    column = margin
    for text, colour in words:
        column = write(image, text, column, height + _HEADER + 17, colour) + 18
    return image
