"""The picture of a flight: the ground with both tracks, the camera's view, and what was spent."""

from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.world.canvas import BLUE, GREEN, INK, ORANGE, RED, Canvas, Colour, write

if TYPE_CHECKING:
    from lidarena.envs.seabed.state import Vehicle

Image = NDArray[np.uint8]

_WIDTH = 640
"""Of the picture, and of each of its parts [pixels]."""
_HEADER, _FOOTER = 46, 26


def draw_vehicle(vehicle: "Vehicle") -> Image:
    """Draw one world, RGB (height, width, 3)."""
    ground = _draw_ground(vehicle)
    view = _draw_view(vehicle)
    image = np.full((_HEADER + len(ground) + 8 + len(view) + _FOOTER, _WIDTH, 3), 255, np.uint8)
    image[_HEADER : _HEADER + len(ground), : ground.shape[1]] = ground
    top = _HEADER + len(ground) + 8
    image[top : top + len(view), : view.shape[1]] = view
    odometry = vehicle.odometry
    state = "REFUSED" if vehicle.refused else f"{odometry.matches} matches"
    write(image, f"frame {vehicle.frame} of {vehicle.last_frame}   skip {vehicle.skip}   {state}", 8, 18)
    told = f"error {100 * vehicle.error:.1f} cm on {vehicle.path_lengths[1]:.1f} m, compute {vehicle.cost:.2f} s"
    write(image, f"{told}, refused {odometry.refused}", 8, 38, INK, 0.42)
    words: list[tuple[str, Colour]] = [
        ("true track", GREEN), ("computed positions", ORANGE), ("features", BLUE), ("vehicle", RED)
    ]  # fmt: skip
    x = 8
    for word, colour in words:
        write(image, word, x, len(image) - 8, colour, 0.42)
        x += 9 * len(word) + 12
    return image


def _draw_ground(vehicle: "Vehicle") -> Image:
    """The relief from above, low ground dark, with both tracks."""
    planar = vehicle.scene.flight.planar
    low, high = planar[:, :2].min(axis=0) - 1.5, planar[:, :2].max(axis=0) + 1.5
    scale = min(_WIDTH / (high[0] - low[0]), 420.0 / (high[1] - low[1]))
    canvas = Canvas((low[0], low[1], high[0], high[1]), scale)
    height, width = canvas.image.shape[:2]
    xs, ys = np.linspace(low[0], high[0], max(width // 4, 2)), np.linspace(high[1], low[1], max(height // 4, 2))
    heights = np.array([[vehicle.scene.seabed.height(x, y) for x in xs] for y in ys])
    shade = (heights - heights.min()) / max(float(np.ptp(heights)), 1e-9)
    coloured = cv2.applyColorMap((255 * shade).astype(np.uint8), cv2.COLORMAP_OCEAN)[:, :, ::-1]
    canvas.image[:] = cv2.resize(np.ascontiguousarray(coloured), (width, height)) // 2 + 100
    canvas.line(planar[: vehicle.frame + 1, :2], GREEN, 3)
    found = np.array(vehicle.positions)[:, :2]
    canvas.line(found, ORANGE, 1)
    canvas.dots(found, ORANGE, 2.0)
    canvas.robot(planar[vehicle.frame], 0.4, RED)
    return canvas.image


def _draw_view(vehicle: "Vehicle") -> Image:
    """The left and the right image at the last computed position, with the features of both."""
    pair = vehicle.store.images(vehicle.scene, vehicle.frame)
    shown = [cv2.cvtColor(one, cv2.COLOR_GRAY2RGB) for one in pair]
    features = vehicle.odometry.features
    if features is not None:
        for pixels in features.pixels:
            for side, image in enumerate(shown):
                place = round(float(pixels[2 * side])), round(float(pixels[2 * side + 1]))
                cv2.circle(image, place, 3, BLUE, 1, cv2.LINE_AA)
    both = np.hstack(shown)
    made: Image = np.asarray(cv2.resize(both, (_WIDTH, round(_WIDTH * both.shape[0] / both.shape[1]))), np.uint8)
    return made
