"""Whether there is a picture to draw, and pictures in a window on the screen (``render_mode="human"``)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def may_draw(render_mode: str | None, begun: bool) -> bool:
    """Whether ``render()`` has something to draw; without a ``render_mode`` a warning tells why not.

    Raises:
        ResetNeeded: No episode has begun.
    """
    if render_mode is None:
        gym.logger.warn("render() needs render_mode='rgb_array' when the environment is made")
        return False
    if not begun:
        raise ResetNeeded("render() needs an episode; call reset() first")
    return True


class Window:
    """A window on the screen, opened with the first picture; where there is no screen nothing is seen."""

    def __init__(self) -> None:
        self._figure: Figure | None = None

    def show(self, picture: NDArray[np.uint8]) -> None:
        """Show a picture (height, width, 3) in place of the one before."""
        if self._figure is None:
            self._figure = _open(picture)
        self._figure.axes[0].images[0].set_data(picture)
        self._figure.canvas.draw_idle()
        self._figure.canvas.flush_events()

    def close(self) -> None:
        """Close it, if it is open."""
        if self._figure is not None:
            from matplotlib import pyplot

            pyplot.close(self._figure)
            self._figure = None


def _open(picture: NDArray[np.uint8]) -> Figure:
    from matplotlib import pyplot  # loads slowly, and is needed by nobody else here

    height, width = picture.shape[:2]
    figure = pyplot.figure(figsize=(width / 100, height / 100))
    if figure.canvas.manager is not None:
        figure.canvas.manager.set_window_title("lidarena")
    figure.add_axes((0.0, 0.0, 1.0, 1.0)).set_axis_off()
    figure.axes[0].imshow(picture)
    if pyplot.get_backend().lower() != "agg":
        figure.show()
    return figure
