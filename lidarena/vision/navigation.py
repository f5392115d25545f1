"""What the vehicle's other instruments add: absolute angles and a Doppler log's velocity."""

import numpy as np
from numpy.typing import NDArray

from lidarena.vision.rigid_motion import motion_of, orthonormal, rotation_of, vector_of

Floats = NDArray[np.float64]


def adjoint(pose: Floats) -> Floats:
    """How a small motion (w, t) before a pose (4, 4) looks after it, (6, 6)."""
    out = np.zeros((6, 6))
    rotation, (x, y, z) = pose[:3, :3], pose[:3, 3]
    out[:3, :3] = out[3:, 3:] = rotation
    out[3:, :3] = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]) @ rotation
    return out


def replace_angles(pose: Floats, attitude: Floats) -> Floats:
    """Put a measured attitude in the place of a pose's own, which keeps its position (Bobkov et al.).

    In their row form this is t_cor = t_vis R_vis⁻¹ R_cor of the matrix from the world to the camera.

    Args:
        pose: (4, 4) camera to world.
        attitude: (3, 3) camera to world, as it was measured.
    """
    return motion_of(attitude, pose[:3, 3])


def fuse_angles(pose: Floats, covariance: Floats, attitude: Floats, sigma: float) -> tuple[Floats, Floats]:
    """Weigh a measured attitude against a pose's own by their variances (Kalman); the position moves with it.

    Args:
        pose: (4, 4) camera to world.
        covariance: (6, 6) of rotation vector and translation before which it stands, ``exp(w) X + t``.
        attitude: (3, 3) camera to world, as it was measured.
        sigma: Standard deviation of the measurement about each axis [rad].

    Returns:
        The corrected pose and its covariance.
    """
    off = vector_of(attitude @ pose[:3, :3].T)
    gain = covariance[:, :3] @ np.linalg.inv(covariance[:3, :3] + sigma**2 * np.eye(3))
    step = gain @ off
    corrected = motion_of(rotation_of(step[:3]), step[3:]) @ pose
    corrected[:3, :3] = orthonormal(corrected[:3, :3])
    rest = covariance - gain @ covariance[:3, :]
    return corrected, 0.5 * (rest + rest.T)


def replace_translation(motion: Floats, displacement: Floats) -> Floats:
    """Put a Doppler log's displacement in the place of a motion's own (Bobkov et al.).

    Args:
        motion: (4, 4) from frame a to frame b.
        displacement: (3,) from a to b as a sees it, the velocity times the time [m].
    """
    return motion_of(motion[:3, :3], -motion[:3, :3] @ displacement)
