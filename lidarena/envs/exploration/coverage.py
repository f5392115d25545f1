"""Map completeness: which cells of a floor plan a robot can come to know."""

import math
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan
from lidarena.world.raster import Raster
from lidarena.world.robots import BUMPER, RobotSpec

START_MARGIN = 0.25
"""Random starts keep this far from every wall [m] …"""
_START_ROOM = 0.05
"""… and this much farther than a collision is, if that is more."""


class Coverage(NamedTuple):
    """What can be covered of one floor plan, on its grid ``[row, column]``.

    Attributes:
        wanted: bool; K, the free space that the robot's disc can reach and the wall cells next to it.
        starts: (n, 2) centres of the cells where a robot may be put at random [m].
        origin: (2,) lower-left corner of the grid [m].
    """

    wanted: NDArray[np.bool_]
    starts: NDArray[np.float64]
    origin: NDArray[np.float64]


def measure_coverage(
    plan: Floorplan, resolution: float, robot: RobotSpec, start_margin: float = START_MARGIN
) -> Coverage:
    """Find K, against whose size completeness is measured: |known ∩ K| / |K|.

    A cell is wanted if the robot's disc, grown by what its collision distance asks for, can cover it, moving from the
    plan's start with its centre at least that distance from every wall (through ways that leave it
    ``robot.clearance``, if that is given; where it is then, it may look into corners from nearer), or if it is a wall
    cell whose surface borders such cells: 100% is attainable in every world. (Counting the whole grid, as DA-SLAM's
    code does, would end at a share that depends on the drawing.)

    Args:
        plan: The floor plan, with its start.
        resolution: Side of a cell [m].
        robot: Of an outline counts the circle that holds it, which can turn wherever it is.
        start_margin: Random starts keep this far from every wall, where there is such a place [m].

    Raises:
        MapError: The robot does not fit where the plan's start is.
    """
    raster = plan.raster(resolution)
    passable = ~raster.solid & (raster.clearance >= robot.bumper)
    reached = _connected(passable, raster, plan.start)
    if robot.clearance is not None and robot.clearance > robot.bumper and reached.any():
        reached &= _within(raster, plan, robot.clearance, robot.bumper)
    if not reached.any():
        raise _no_room(plan, robot)
    away = cv2.distanceTransform((~reached).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) * resolution
    covered = ~raster.solid & (away <= robot.bumper - BUMPER + 0.5 * resolution)
    beside = cv2.dilate(covered.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool)
    surface = raster.solid & (raster.clearance <= 0.55 * resolution)
    return Coverage(covered | (surface & beside), _start_places(reached, raster, robot, start_margin), raster.origin)


def check_start(plan: Floorplan, robot: RobotSpec) -> None:
    """Refuse a floor plan at whose start the robot would collide.

    Raises:
        MapError: It names the start.
    """
    if plan.clearance(np.array([plan.start[:2]]))[0] < robot.bumper:
        raise _no_room(plan, robot)


def _within(raster: Raster, plan: Floorplan, clearance: float, bumper: float) -> NDArray[np.bool_]:
    """Where a robot can be (rows, columns) that keeps ``clearance`` on its ways and ``bumper`` at their ends.

    Raises:
        MapError: It cannot at the plan's start.
    """
    roomy = _connected(~raster.solid & (raster.clearance >= clearance), raster, plan.start)
    if not roomy.any():
        x, y, _ = plan.start
        raise MapError(
            f"a robot that keeps a clearance of {clearance:g} m does not fit at the start ({x:g}, {y:g}) of map "
            f"{plan.name!r}; a smaller robot.clearance or another start is needed"
        )
    away = cv2.distanceTransform((~roomy).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) * raster.resolution
    near: NDArray[np.bool_] = away <= (clearance - bumper) * math.sqrt(2.0) + raster.resolution  # into right angles
    return near


def _no_room(plan: Floorplan, robot: RobotSpec) -> MapError:
    x, y, _ = plan.start
    return MapError(
        f"a robot that collides at {robot.bumper:g} m from its centre does not fit at the start ({x:g}, {y:g}) of map "
        f"{plan.name!r}; a smaller robot or collision_distance, or another start is needed"
    )


def _connected(passable: NDArray[np.bool_], raster: Raster, start: tuple[float, float, float]) -> NDArray[np.bool_]:
    _, labels = cv2.connectedComponents(passable.astype(np.uint8), connectivity=4)
    column, row = np.floor((np.array(start[:2]) - raster.origin) / raster.resolution).astype(int)
    label = labels[row, column]
    if not passable[row, column]:  # the start itself is passable, its cell's centre may be a hair too close
        near = labels[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
        label = near.max()
    reached: NDArray[np.bool_] = (labels == label) & (labels > 0)
    return reached


def _start_places(reached: NDArray[np.bool_], raster: Raster, robot: RobotSpec, margin: float) -> NDArray[np.float64]:
    roomy = reached & (raster.clearance >= max(margin, robot.bumper + _START_ROOM))
    cells = np.argwhere(roomy if roomy.any() else reached)
    return raster.origin + (cells[:, ::-1] + 0.5) * raster.resolution
