"""Drawing in metres: a picture of a piece of the plane, y up, with OpenCV's anti-aliased lines."""

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.world.floorplan import Floorplan

Colour = tuple[int, int, int]
WHITE: Colour = (255, 255, 255)
INK: Colour = (40, 42, 54)
GREY: Colour = (150, 154, 164)
BLUE: Colour = (31, 102, 217)
ORANGE: Colour = (230, 126, 20)
GREEN: Colour = (24, 145, 72)
RED: Colour = (214, 40, 57)
MAGENTA: Colour = (190, 24, 170)

_SHIFT = 4  # fractional bits of OpenCV's coordinates


class Canvas:
    """An RGB picture ``(height, width, 3)`` of the rectangle ``bounds``.

    Args:
        bounds: x_min, y_min, x_max, y_max [m].
        scale: Pixels a metre.
    """

    def __init__(self, bounds: tuple[float, float, float, float], scale: float) -> None:
        self.bounds, self.scale = bounds, scale
        width = math.ceil((bounds[2] - bounds[0]) * scale)
        height = math.ceil((bounds[3] - bounds[1]) * scale)
        self.image: NDArray[np.uint8] = np.full((height, width, 3), 255, np.uint8)

    def _pixels(self, points: NDArray[np.float64]) -> NDArray[np.int32]:
        columns = (points[:, 0] - self.bounds[0]) * self.scale
        rows = self.image.shape[0] - (points[:, 1] - self.bounds[1]) * self.scale
        return np.round(np.stack([columns, rows], axis=1) * (1 << _SHIFT)).astype(np.int32)

    def cells(self, colours: NDArray[np.uint8], origin: NDArray[np.float64], resolution: float) -> None:
        """Paint a grid of colours (rows, columns, 3), row 0 at the smallest y, over everything it covers."""
        height, width = self.image.shape[:2]
        x = self.bounds[0] + (np.arange(width) + 0.5) / self.scale
        y = self.bounds[1] + (height - np.arange(height) - 0.5) / self.scale
        columns = np.floor((x - origin[0]) / resolution).astype(int)
        rows = np.floor((y - origin[1]) / resolution).astype(int)
        within_x = (columns >= 0) & (columns < colours.shape[1])
        within_y = (rows >= 0) & (rows < colours.shape[0])
        self.image[np.ix_(within_y, within_x)] = colours[np.ix_(rows[within_y], columns[within_x])]

    def line(self, points: NDArray[np.float64], colour: Colour, width: int = 2) -> None:
        """A polyline through ``points`` (n, 2) [m]."""
        if len(points) > 1:
            cv2.polylines(self.image, [self._pixels(points)], False, colour, width, cv2.LINE_AA, _SHIFT)

    def dots(self, points: NDArray[np.float64], colour: Colour, radius: float = 1.5) -> None:
        """Discs of ``radius`` pixels at ``points`` (n, 2) [m]."""
        for column, row in self._pixels(points):
            centre = (int(column), int(row))
            cv2.circle(self.image, centre, round(radius * (1 << _SHIFT)), colour, -1, cv2.LINE_AA, _SHIFT)

    def robot(self, pose: NDArray[np.float64], radius: float, colour: Colour) -> None:
        """A disc robot (3,) with its heading, at least 5 pixels large."""
        size = max(radius, 5.0 / self.scale)
        centre = pose[None, :2]
        nose = centre + 1.9 * size * np.array([[math.cos(pose[2]), math.sin(pose[2])]])
        self.dots(centre, WHITE, size * self.scale + 1.5)
        self.dots(centre, colour, size * self.scale)
        self.line(np.vstack([centre, nose]), colour, 2)

    def ellipse(self, centre: NDArray[np.float64], covariance: NDArray[np.float64], colour: Colour) -> None:
        """The 2-σ ellipse of a position's covariance (2, 2) [m²]."""
        values, axes = np.linalg.eigh(covariance)
        turn = np.linspace(0.0, 2.0 * np.pi, 48)
        ring = 2.0 * np.sqrt(np.maximum(values, 0.0)) * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        self.line(centre + ring @ axes.T, colour, 2)

    def scale_bar(self) -> None:
        """A bar of one metre in the lower-left corner."""
        x, y = self.bounds[0] + 8 / self.scale, self.bounds[1] + 8 / self.scale
        self.line(np.array([[x, y], [x + 1.0, y]]), INK, 3)
        where = (int(self.scale) + 14, self.image.shape[0] - 5)
        cv2.putText(self.image, "1 m", where, cv2.FONT_HERSHEY_SIMPLEX, 0.4, INK, 1, cv2.LINE_AA)


def draw_floorplan(canvas: Canvas, plan: Floorplan) -> None:
    """Paint a floor plan's solid parts dark on white."""
    raster = plan.raster(0.05)
    fill = np.where(raster.solid[..., None], np.array(GREY, np.uint8), np.array(WHITE, np.uint8))
    canvas.cells(fill.astype(np.uint8), raster.origin, raster.resolution)
    for x1, y1, x2, y2 in plan.edges:
        canvas.line(np.array([[x1, y1], [x2, y2]]), INK, 1)
    turn = np.linspace(0.0, 2.0 * np.pi, 48)
    for x, y, radius in plan.circles:
        canvas.line(np.array([x, y]) + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1), INK, 1)


def write(
    image: NDArray[np.uint8], text: str, left: int, baseline: int, colour: Colour = INK, size: float = 0.42
) -> int:
    """Write into a picture (height, width, 3) and return the column where the text ends."""
    cv2.putText(image, text, (left, baseline), cv2.FONT_HERSHEY_SIMPLEX, size, colour, 1, cv2.LINE_AA)
    (width, _), _ = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, size, 1)
    return left + int(width)
