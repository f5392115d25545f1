"""Explorers in a batch of exploration worlds, run on all cores."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel
from lidarena.envs.exploration.actions import discrete_commands
from lidarena.envs.exploration.goal_choice.features import Circumstances, describe
from lidarena.envs.exploration.options import ROBOT, ExplorationOptions
from lidarena.envs.exploration.room import least_distance, sees_what_is_near
from lidarena.planning.driving.explorer import (
    CHOOSES,
    DRIVES,
    Explorers,
    ExplorerSettings,
    advance,
    command,
    set_out,
)
from lidarena.planning.driving.state import DriverSettings, LidarView, Perceptions, make_settings
from lidarena.planning.grid.steering import Commands
from lidarena.slam.readings import Share, next_world

_TIMEOUT, _PATIENCE, _ENCLOSED, _FRUITLESS = 30.0, 2.0, 20.0, 120.0  # [s]
_ADVANTAGE_RADIUS = 15.0  # [m], Ericson et al.'s


class Crew(NamedTuple):
    """What the kernels need to explore W worlds.

    Attributes:
        driver: How robots drive.
        settings: When a choice is due.
        explorers: Their state.
        status: (W,) ``DRIVES``, ``CHOOSES`` or ``ENDS``.
        commands: (W,) number of the next command.
        rows: (W, K, FEATURES + K) what is told of the candidates.
    """

    driver: DriverSettings
    settings: ExplorerSettings
    explorers: Explorers
    status: NDArray[np.int64]
    commands: NDArray[np.int64]
    rows: NDArray[np.float32]


def driver_settings(options: ExplorationOptions, commands: Commands, resolution: float) -> DriverSettings:
    """Return how a world's robot drives with some commands."""
    robot, lidar = options.robot, options.lidar
    view = LidarView(lidar.angles, sees_what_is_near(options))
    extra = robot.bumper - ROBOT.bumper
    return make_settings(commands, view, lidar.max_range, extra, least_distance(options), resolution)


def discrete_driver(options: ExplorationOptions, resolution: float) -> DriverSettings:
    """Return how a world's robot drives with DA-SLAM's three commands."""
    commands = Commands.of(discrete_commands(options.robot), options.decision_period)
    return driver_settings(options, commands, resolution)


def explorer_settings(period: float, choice_period: float, least_frontier: float, places: int) -> ExplorerSettings:
    """Return when a choice is due and what is told, from seconds and metres."""
    every, timeout, patience, enclosed, fruitless = (
        max(1, round(seconds / period)) for seconds in (choice_period, _TIMEOUT, _PATIENCE, _ENCLOSED, _FRUITLESS)
    )
    return ExplorerSettings(
        every, timeout, patience, enclosed, fruitless, least_frontier, places, _ADVANTAGE_RADIUS, period
    )


@kernel
def set_out_all(share: Share, choices: NDArray[np.int64], senses: Perceptions, crew: Crew) -> None:
    """Set out for what was chosen, world after world, and find the next command."""
    w = next_world(share)
    while w < share.last:
        set_out(w, choices[w], senses, crew.driver, crew.explorers)
        crew.commands[w] = command(w, senses, crew.driver, crew.explorers)
        crew.status[w] = DRIVES
        w = next_world(share)


@kernel
def advance_all(share: Share, around: Circumstances, senses: Perceptions, crew: Crew) -> None:
    """Take in what the robots sense, world after world: find the next command, or describe what to choose from."""
    w = next_world(share)
    while w < share.last:
        explorers, driver = crew.explorers, crew.driver
        status = advance(w, around.log_d[w], senses, driver, crew.settings, explorers)
        if status == CHOOSES and explorers.candidates.number[w] == 1:
            set_out(w, 0, senses, driver, explorers)
            status = DRIVES
        if status == CHOOSES:
            describe(w, around, explorers, crew.rows[w])
        elif status == DRIVES:
            crew.commands[w] = command(w, senses, driver, explorers)
        crew.status[w] = status
        w = next_world(share)
