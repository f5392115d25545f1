"""Pictures of the worlds of a batch: as arrays, or in a window."""

import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.rendering import TeamScene, draw_team


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
    picture = draw_team(scene, trails.paths(world), episodes.sketches[world])
    if episodes.options.render_mode == "rgb_array":
        return picture
    episodes.window.show(picture)
    return None
