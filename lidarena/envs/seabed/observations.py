"""What a policy sees of the odometry."""

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.seabed.scenes import RATE
from lidarena.envs.seabed.state import Vehicle
from lidarena.vision.step_size import adaptive_step

NAMES = (
    "matches / 200", "overlap", "nearest ground / 10 m", "speed [m/s]", "turning [rad/s]",
    "position uncertainty / 5 cm", "heading uncertainty / 0.1 degrees", "last skip / 64", "last step refused",
    "last compute / 0.1 s",
    "frames left / 96, at most 1", "frames to an overlap of 75% / 64", "matches over features",
)  # fmt: skip
"""Of the numbers of the observation."""
LARGEST = 10.0
"""No number is larger."""


def observe(vehicle: Vehicle) -> NDArray[np.float32]:
    """The observation of one world, (13,), each from 0 to ``LARGEST``."""
    odometry, camera = vehicle.odometry, vehicle.camera
    depth = float(np.nan_to_num(odometry.depth, nan=0.0))
    position, heading = vehicle.uncertainty.tolist()
    ideal = adaptive_step(camera, depth, vehicle.speed, RATE, 0.75)
    features = 0 if odometry.features is None else len(odometry.features.pixels)
    seen = np.array([
        odometry.matches / 200.0,
        vehicle.overlap,
        depth / 10.0,
        vehicle.speed,
        vehicle.turn_rate,
        position / 0.05,
        np.degrees(heading) / 0.1,
        vehicle.skip / 64.0,
        float(vehicle.refused),
        vehicle.spent / 0.1,
        min((vehicle.last_frame - vehicle.frame) / 96.0, 1.0),  # no clock, by which flights could be learned by heart
        ideal / 64.0,
        odometry.matches / max(features, 1),
    ])  # fmt: skip
    return np.asarray(np.clip(seen, 0.0, LARGEST), np.float32)
