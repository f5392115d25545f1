"""How near an exploration robot may come to what its beams hit, and whether they hit all that is near."""

from lidarena.envs.exploration.options import ExplorationOptions

_SLACK, _SIGMAS = 0.015, 1.5
_FEWEST = 90


def least_distance(options: ExplorationOptions) -> float:
    """Distance to what a beam has hit below which commands are not given [m].

    It leaves 0.015 m beside a collision, or 1.5 standard deviations of a noisier lidar: the nearest of many hits is
    about two of them nearer than what was hit, so that some 0.03 m remain.
    """
    return options.robot.bumper + max(_SLACK, _SIGMAS * options.lidar.noise)


def sees_what_is_near(options: ExplorationOptions) -> bool:
    """Whether nothing near the robot is hidden between two beams, outside of the field of view, or too near."""
    lidar = options.lidar
    return lidar.sees_all_around and lidar.beams >= _FEWEST and lidar.min_range <= options.robot.bumper
