"""The picture of an exploration world in which choices are made: what there is to choose from, and the way there."""

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.exploration.rendering import draw_exploration
from lidarena.envs.exploration.state import ExplorationCore
from lidarena.envs.path_recorder import PathRecorder
from lidarena.planning.driving.candidates import FRONTIER
from lidarena.planning.driving.explorer import Explorers
from lidarena.world.canvas import Canvas, Colour

TEAL: Colour = (0, 150, 150)
VIOLET: Colour = (110, 70, 200)
_LEGEND: list[tuple[str, Colour]] = [("frontiers, way", TEAL), ("places", VIOLET)]


def draw_choices(core: ExplorationCore, recorder: PathRecorder, explorers: Explorers, world: int) -> NDArray[np.uint8]:
    """Draw one world, RGB (height, width, 3): as ever, and the candidates and the way that is driven in the belief."""

    def add(belief: Canvas) -> None:
        candidates, drive = explorers.candidates, explorers.drive
        if drive.has_goal[world]:
            belief.line(drive.path[world, : drive.path_points[world]], TEAL, 2)
            belief.dots(drive.goal[world][None], TEAL, 7.0)
        count = int(candidates.number[world])
        frontiers = candidates.kind[world, :count] == FRONTIER
        goals = candidates.goals[world, :count, 0]
        belief.dots(goals[frontiers], TEAL, 4.0)
        belief.dots(goals[~frontiers], VIOLET, 4.0)

    return draw_exploration(core, recorder, world, add, _LEGEND)
