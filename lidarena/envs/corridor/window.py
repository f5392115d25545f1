"""Pictures of the worlds of a batch: as arrays, or in a window."""

from typing import Any

import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.rendering import TeamScene, draw_team

_windows: dict[int, Any] = {}
"""What shows each batch in a window, by the batch's identity."""


def draw_world(episodes: CorridorEpisodes, world: int) -> NDArray[np.uint8] | None:
    """Draw a world in the way its ``render_mode`` says.

    Returns:
        The picture (height, width, 3); None without a ``render_mode``, or where a window shows it.

    Raises:
        ResetNeeded: No episode has begun.
    """
    trails = episodes.trails
    if trails is None:
        return None
    if not trails.begun(world):
        raise ResetNeeded("render() needs an episode; call reset() first")
    core = episodes.core
    scene = TeamScene(
        core.plan,
        core.physics.poses[world],
        core.goals[world],
        episodes.arrived[world],
        episodes.touches[world] > 0,
        core.robot.radius,
        float(episodes.time[world]),
    )
    picture = draw_team(scene, trails.trails(world), episodes.sketches[world])
    if episodes.options.render_mode == "rgb_array":
        return picture
    _show(episodes, picture)
    return None


def close_window(episodes: CorridorEpisodes) -> None:
    """Close the window of a batch, if it has one."""
    figure = _windows.pop(id(episodes), None)
    if figure is not None:
        from matplotlib import pyplot

        pyplot.close(figure)


def _show(episodes: CorridorEpisodes, picture: NDArray[np.uint8]) -> None:
    """Put a picture into a window; where there is no screen nothing is seen."""
    from matplotlib import pyplot  # loads slowly, and is needed by nobody else here

    figure = _windows.get(id(episodes))
    if figure is None:
        height, width = picture.shape[:2]
        figure = _windows[id(episodes)] = pyplot.figure("lidarena", figsize=(width / 100, height / 100))
        figure.add_axes((0.0, 0.0, 1.0, 1.0)).set_axis_off()
        figure.axes[0].imshow(picture)
        if pyplot.get_backend().lower() != "agg":
            figure.show()
    figure.axes[0].images[0].set_data(picture)
    figure.canvas.draw_idle()
    figure.canvas.flush_events()
