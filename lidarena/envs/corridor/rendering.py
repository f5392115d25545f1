"""The picture of a multi-robot world: robots and goals, where they went, what they plan, and who waits for whom."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.world.canvas import GREY, INK, ORANGE, RED, WHITE, Canvas, Colour, draw_floorplan, write
from lidarena.world.floorplan import Floorplan

COLOURS: tuple[Colour, ...] = (
    (31, 102, 217), (214, 98, 12), (24, 145, 72), (190, 24, 170), (120, 80, 40), (0, 140, 160), (130, 110, 0),
    (110, 60, 200),
)  # fmt: skip
"""Of the robots, over and over."""
_LONG_SIDE = 900
_HEADER, _FOOTER = 28, 44


@dataclass(frozen=True)
class TeamSketch:
    """What a planner wants to be seen.

    Attributes:
        curves: Robot -> (n, 2) the points that it still plans to pass [m].
        conflicts: (n, 2) where plans would meet [m].
        waits: Pairs (i, j): robot i waits for robot j.
        note: One line about the plan.
    """

    curves: dict[int, NDArray[np.float64]] = field(default_factory=dict)
    conflicts: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 2)))
    waits: tuple[tuple[int, int], ...] = ()
    note: str = ""


@dataclass(frozen=True)
class TeamScene:
    """One world at one moment; arrays over its robots.

    Attributes:
        plan: The floor plan.
        poses: (k, 3).
        goals: (k, 2).
        arrived: (k,).
        crashed: (k,).
        radius: Of every robot [m].
        time: Since the episode began [s].
    """

    plan: Floorplan
    poses: NDArray[np.float64]
    goals: NDArray[np.float64]
    arrived: NDArray[np.bool_]
    crashed: NDArray[np.bool_]
    radius: float
    time: float


def draw_team(scene: TeamScene, trails: NDArray[np.float64], sketch: TeamSketch) -> NDArray[np.uint8]:
    """Draw a world, RGB (height, width, 3)."""
    low_x, low_y, high_x, high_y = scene.plan.bounds
    bounds = (low_x - 0.1, low_y - 0.1, high_x + 0.1, high_y + 0.1)
    canvas = Canvas(bounds, _LONG_SIDE / max(bounds[2] - bounds[0], bounds[3] - bounds[1]))
    draw_floorplan(canvas, scene.plan)
    robots = range(len(scene.poses))
    for robot in robots:
        canvas.line(trails[robot], _pale(_colour(robot)), 2)
    for robot, curve in sketch.curves.items():
        canvas.dots(_evenly(curve, 0.2), _colour(robot), 1.6)
    for robot in robots:
        _draw_goal(canvas, scene.goals[robot], _colour(robot), bool(scene.arrived[robot]))
    for point in sketch.conflicts:
        _draw_cross(canvas, point, RED)
    for waiting, other in sketch.waits:
        _draw_arrow(canvas, scene.poses[waiting, :2], scene.poses[other, :2], ORANGE)
    for robot in robots:
        canvas.robot(scene.poses[robot], scene.radius, _colour(robot))
        if scene.crashed[robot]:
            _draw_cross(canvas, scene.poses[robot, :2], INK)
    _number_robots(canvas, scene)
    return _compose(canvas.image, scene, sketch)


def _colour(robot: int) -> Colour:
    return COLOURS[robot % len(COLOURS)]


def _pale(colour: Colour) -> Colour:
    red, green, blue = (255 - round(0.45 * (255 - part)) for part in colour)
    return red, green, blue


def _evenly(curve: NDArray[np.float64], spacing: float) -> NDArray[np.float64]:
    """Points along a curve (n, 2) at about equal distances."""
    if len(curve) < 2:
        return curve
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(curve, axis=0).T))])
    at = np.arange(0.0, lengths[-1] + 1e-9, spacing)
    return np.stack([np.interp(at, lengths, curve[:, k]) for k in range(2)], axis=1)


def _ring(centre: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    turn = np.linspace(0.0, 2.0 * np.pi, 25)
    return centre + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)


def _draw_goal(canvas: Canvas, goal: NDArray[np.float64], colour: Colour, reached: bool) -> None:
    radius = 9.0 / canvas.scale
    canvas.line(_ring(goal, radius), colour, 2)
    if reached:
        tick = goal + np.array([(-0.5, 0.0), (-0.1, -0.5), (0.6, 0.6)]) * radius
        canvas.line(tick, colour, 2)
    else:
        canvas.dots(goal[None], colour, 2.5)


def _draw_cross(canvas: Canvas, point: NDArray[np.float64], colour: Colour) -> None:
    size = 7.0 / canvas.scale
    for a, b in (((-1, -1), (1, 1)), ((-1, 1), (1, -1))):
        canvas.line(point + size * np.array([a, b], np.float64), colour, 3)


def _draw_arrow(canvas: Canvas, start: NDArray[np.float64], end: NDArray[np.float64], colour: Colour) -> None:
    away = end - start
    length = float(np.hypot(*away))
    if length < 1e-6:
        return
    along = away / length
    aside, size = np.array([-along[1], along[0]]), 9.0 / canvas.scale
    tip = end - 9.0 / canvas.scale * along
    canvas.line(np.stack([start, tip]), colour, 2)
    canvas.line(np.stack([tip - size * along + 0.6 * size * aside, tip]), colour, 2)
    canvas.line(np.stack([tip - size * along - 0.6 * size * aside, tip]), colour, 2)


def _number_robots(canvas: Canvas, scene: TeamScene) -> None:
    for robot, pose in enumerate(scene.poses):
        places = [(pose[:2], 11), (scene.goals[robot], 12)]
        for point, shift in places[: 1 if scene.arrived[robot] else 2]:  # two numbers in one place cannot be read
            column = round((point[0] - canvas.bounds[0]) * canvas.scale) + shift
            row = canvas.image.shape[0] - round((point[1] - canvas.bounds[1]) * canvas.scale) - 6
            write(canvas.image, str(robot), column, row, WHITE, 0.45)
            write(canvas.image, str(robot), column, row, _colour(robot), 0.45)


def _compose(picture: NDArray[np.uint8], scene: TeamScene, sketch: TeamSketch) -> NDArray[np.uint8]:
    height, width = picture.shape[:2]
    image = np.full((height + _HEADER + _FOOTER, max(width, 640), 3), 255, np.uint8)
    left = (image.shape[1] - width) // 2
    image[_HEADER : _HEADER + height, left : left + width] = picture
    words = f"{scene.plan.name}   {scene.time:.1f} s   {int(scene.arrived.sum())} of {len(scene.poses)} robots arrived"
    if scene.crashed.any():
        words += f"   COLLISION of {', '.join(str(robot) for robot in np.flatnonzero(scene.crashed))}"
    write(image, words, 8, 18)
    at = _HEADER + height + 17
    column = write(image, "robot k and its goal (ring)", left + 4, at) + 18
    column = write(image, "its trail (pale)", column, at, GREY) + 18
    if sketch.curves:
        column = write(image, "its plan (dots)", column, at) + 18
        column = write(image, "plans meet (cross)", column, at, RED) + 18
        write(image, "waits for (arrow)", column, at, ORANGE)
    write(image, sketch.note, left + 4, at + 19, GREY)
    return image
