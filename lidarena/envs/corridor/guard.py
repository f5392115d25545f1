"""What keeps robots of a team from driving into what their lidar shows: none uses up more than half of the room."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf

MARGIN = 0.03
"""Room that is kept to whatever a beam meets [m], for what hides between two beams and in their noise."""
SLACK = 1.4
"""Robots may drive so many times as fast as they are told: twice the deviation of their wheels."""


@leaf
def guard_speeds(
    scans: NDArray[np.float32],
    directions: NDArray[np.float64],
    max_range: float,
    radius: float,
    period: float,
    turn: float,
    commands: NDArray[np.float64],
) -> None:
    """Slow down, in place, whoever would come too near to something in the next period, and turn it aside.

    Of the room between a robot and what a beam meets, less ``MARGIN``, one period may use up half. Two robots that
    drive at each other therefore never meet; whoever drives away from something is not held up, nor is who drives along
    a wall with some 6 cm of room. Whoever loses more than half of its speed turns away from what stands in its way, so
    that nobody stands before a corner for ever, and two that meet pass each other on the same side.

    Args:
        scans: (W, R, beams) measured ranges [m]; 0 is nearer than the lidar can measure.
        directions: (2, beams) cosines and sines of the beams' angles.
        max_range: Beams that measure this met nothing [m].
        radius: Of the robots [m].
        period: [s].
        turn: Rate at which to turn aside [rad/s].
        commands: (W, R, 2) speed [m/s] and turn rate [rad/s], changed.
    """
    for w in range(commands.shape[0]):
        for r in range(commands.shape[1]):
            speed, half_turn = commands[w, r, 0], 0.5 * commands[w, r, 1] * period
            if speed == 0.0:
                continue
            sign = 1.0 if speed > 0.0 else -1.0
            ux, uy = sign * math.cos(half_turn), sign * math.sin(half_turn)
            wanted = SLACK * abs(speed) * period
            room, side = wanted, 0.0
            for k in range(scans.shape[2]):
                measured = scans[w, r, k]
                if measured >= max_range or measured - radius - MARGIN >= 2.0 * room:
                    continue
                gap = max(measured - radius, 0.0)
                away = radius + gap
                along = away * (directions[0, k] * ux + directions[1, k] * uy)
                keep = radius + min(0.5 * (gap + MARGIN), gap)  # how near it may come
                beside = away * away - along * along
                if along > 0.0 and beside < keep * keep:
                    until = max(along - math.sqrt(keep * keep - beside), 0.0)
                    if until < room:
                        room, side = until, directions[1, k] * ux - directions[0, k] * uy
            commands[w, r, 0] = sign * min(abs(speed), room / (SLACK * period))
            if room < 0.5 * wanted:
                commands[w, r, 1] = -turn if side >= 0.0 else turn
