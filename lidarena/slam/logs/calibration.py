"""What wheels get wrong in the same way all along, found by comparing them with matched scans.

A wheel's radius that is off by a few per cent, or a robot that pulls to one side, is not the noise of a motion model:
in a bare corridor, where scans do not tell how far the robot came, it adds up to a metre, and no loop closes then.
(On the Intel log the wheels tell 4% too much and miss a turn of 3° a metre.)
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.planar import between, wrapped

_FEWEST = 30
"""Steps below which nothing is believed."""
_ROUNDS, _OUTLIER = 5, 2.5
"""Fits, each without the steps that missed the one before by more than so many robust standard deviations."""
_LARGEST = (0.2, 0.2, 0.3)
"""Corrections of scale, turn and bend beyond these are no calibration but a wrong match."""


class OdometryCalibration(NamedTuple):
    """What to make of an odometry reading (dx, dy, dθ): (scale·dx, scale·dy, turn·dθ + bend·dx).

    Attributes:
        scale: Factor on distances.
        turn: Factor on turns.
        bend: Turn for a metre ahead [rad/m].
    """

    scale: float = 1.0
    turn: float = 1.0
    bend: float = 0.0


def fit_calibration(by_wheels: NDArray[np.float64], by_scans: NDArray[np.float64]) -> OdometryCalibration:
    """The calibration under which the wheels' motions fit the matched ones best, by trimmed least squares.

    Args:
        by_wheels: (K, 3) motions.
        by_scans: (K, 3) the same motions by scan matching.

    Returns:
        No correction where there are too few motions, or where it would be too large to be one.
    """
    if len(by_wheels) < _FEWEST:
        return OdometryCalibration()
    (scale,) = _trimmed_fit(by_wheels[:, :1], by_scans[:, 0])
    turn, bend = _trimmed_fit(by_wheels[:, [2, 0]], by_scans[:, 2])
    found = OdometryCalibration(float(scale), float(turn), float(bend))
    off = np.abs(np.subtract(found, OdometryCalibration()))
    return found if np.all(off <= _LARGEST) else OdometryCalibration()


def _trimmed_fit(causes: NDArray[np.float64], effect: NDArray[np.float64]) -> NDArray[np.float64]:
    """Coefficients of ``effect`` (K,) on ``causes`` (K, c) by least squares, outliers left out round by round."""
    kept = np.ones(len(effect), np.bool_)
    solution: NDArray[np.float64] = np.zeros(causes.shape[1])
    for _ in range(_ROUNDS):
        solution = np.asarray(np.linalg.lstsq(causes[kept], effect[kept])[0], np.float64)
        missed = np.abs(effect - causes @ solution)
        kept = missed <= _OUTLIER * 1.4826 * np.median(missed) + 1e-9
    return solution


def calibrated(odometry: NDArray[np.float64], calibration: OdometryCalibration) -> NDArray[np.float64]:
    """The path (R, 3) that the wheels would have told with the calibration, from the same first pose on."""
    steps = between(odometry[:-1], odometry[1:])
    turns = calibration.turn * steps[:, 2] + calibration.bend * steps[:, 0]
    headings = odometry[0, 2] + np.concatenate([[0.0], np.cumsum(turns)])
    cos, sin = calibration.scale * np.cos(headings[:-1]), calibration.scale * np.sin(headings[:-1])
    dx, dy = cos * steps[:, 0] - sin * steps[:, 1], sin * steps[:, 0] + cos * steps[:, 1]
    x, y = (start + np.concatenate([[0.0], np.cumsum(d)]) for start, d in ((odometry[0, 0], dx), (odometry[0, 1], dy)))
    return np.stack([x, y, wrapped(headings)], axis=1)
