"""Pictures of the seabed as a stereo camera takes them, by casting a ray for every pixel."""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.base.jit import kernel, leaf
from lidarena.base.random_streams import normal
from lidarena.vision.camera import StereoCamera
from lidarena.vision.seabed import Seabed
from lidarena.vision.texture import HeightGrid, TextureTile, blended_texture, height_at, surface
from lidarena.vision.water import Water

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]

_FARTHEST, _ENTRIES = 64.0, 4096
"""What depends on depth is read from tables up to here [m]."""
_STILL, _CLOSE = 8, 1e-3
"""Newton's steps a pixel at most, and the height above the ground from which the next one arrives [m]: the error is of
the second order, some micrometres."""
_LEAST_STEP = 0.005
"""Shortest step along a ray of which Newton's method has lost sight [m]."""
_FADE = 1.5
"""Levels over which the finest texture fades out."""
_LEAST = 0.05
"""A camera is at least so far above the seabed [m]."""


class _Optics(NamedTuple):
    """Tables of a camera in water.

    Attributes:
        light: (height, width) float32 share of light that the lens lets through.
        veil: (height, width) float32 grey of water without end.
        clear: (_ENTRIES,) float32 share of light that passes so much water.
        lod: (_ENTRIES,) float32 binary logarithm of the pixel's side on the ground [m].
        noise: Standard deviation of the grey.
    """

    light: NDArray[np.float32]
    veil: NDArray[np.float32]
    clear: NDArray[np.float32]
    lod: NDArray[np.float32]
    noise: float


class _View(NamedTuple):
    """One camera: where it is (3,), its axes as the columns of (3, 3), focal length and principal point."""

    place: Floats
    axes: Floats
    focal: float
    center_x: float
    center_y: float


def render_pair(
    seabed: Seabed, camera: StereoCamera, pose: Floats, water: Water, stream: NDArray[np.uint64]
) -> tuple[Image, Image]:
    """Take a pair of pictures.

    Args:
        seabed: What is seen.
        camera: Both cameras.
        pose: (4, 4) of the left one, camera to world.
        water: Between.
        stream: State (4,) of the noise's random stream, which moves on; see ``lidarena.base.random_streams``.

    Returns:
        The left and the right image (height, width), uint8.

    Raises:
        VisionError: The pose is not finite, the camera is below the seabed, or looks up.
    """
    _check_pose(seabed, pose)
    optics = _optics_of(camera, water)
    images = []
    for offset in (0.0, camera.baseline):
        place = pose[:3, 3] + offset * pose[:3, 0]
        view = _View(place, np.ascontiguousarray(pose[:3, :3]), camera.focal, camera.center_x, camera.center_y)
        image = np.empty((camera.height, camera.width), np.uint8)
        if not _render(seabed.grid, seabed.sand, seabed.fine, view, optics, stream, image):
            raise VisionError(f"the camera at {np.round(pose[:3, 3], 2).tolist()} m sees past the seabed")
        images.append(image)
    return images[0], images[1]


def _check_pose(seabed: Seabed, pose: Floats) -> None:
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        raise VisionError(f"pose = {pose!r} must be 4 x 4 finite numbers")
    x, y, z = pose[:3, 3].tolist()
    ground = seabed.height(x, y)
    if z < ground + _LEAST:
        raise VisionError(
            f"the camera at {x:.2f}, {y:.2f} m has height {z:.2f} m, the seabed below it {ground:.2f} m; "
            f"{_LEAST} m above it or more are allowed"
        )
    if pose[2, 2] > -0.5:
        raise VisionError("the camera looks more than 60 degrees away from straight down; the seabed is a height field")


@lru_cache(maxsize=32)
def _optics_of(camera: StereoCamera, water: Water) -> _Optics:
    rows, columns = np.mgrid[0 : camera.height, 0 : camera.width]
    across, down = columns - camera.center_x, rows - camera.center_y
    radius = np.hypot(across, down) / max(math.hypot(camera.center_x, camera.center_y), 1.0)
    light = 1.0 - water.vignetting * radius**2
    veil = water.backscatter * (1.0 - 0.4 * radius**2)
    depths = (np.arange(_ENTRIES) + 0.5) * (_FARTHEST / _ENTRIES)
    clear, lod = np.exp(-water.haze * depths), np.log2(depths / camera.focal)
    light, veil, clear, lod = (table.astype(np.float32) for table in (light, veil, clear, lod))
    return _Optics(light, veil, clear, lod, water.noise)


@leaf
def _first_hit(grid: HeightGrid, place: Floats, dx: float, dy: float, dz: float) -> float:
    """Depth at which a ray first meets the seabed [m], to a tenth of a millimetre; 0 if it does not.

    Where a slope hides what is behind it, Newton's method jumps to and fro between the two. Steps of half the height
    above the ground miss nothing unless that is steeper than the ray.
    """
    above, depth = 0.0, 0.0
    while depth < _FARTHEST:
        gap = place[2] + depth * dz - height_at(grid, place[0] + depth * dx, place[1] + depth * dy)
        if gap <= 0.0:
            break
        above = depth
        depth += max(0.5 * gap, _LEAST_STEP)
    if depth == 0.0 or depth >= _FARTHEST:
        return 0.0
    while depth - above > 1e-4:
        middle = 0.5 * (above + depth)
        if place[2] + middle * dz > height_at(grid, place[0] + middle * dx, place[1] + middle * dy):
            above = middle
        else:
            depth = middle
    return 0.5 * (above + depth)


@kernel
def _render(
    grid: HeightGrid,
    sand: TextureTile,
    fine: TextureTile,
    view: _View,
    optics: _Optics,
    stream: NDArray[np.uint64],
    image: Image,
) -> bool:
    """Write one camera's picture (height, width); returns whether every ray met the seabed.

    A ray's parameter is the depth. Newton's method starts where the two pixels to the left lead to, and has nearly
    arrived; a line's first pixel starts at that of the line above.
    """
    height, width = image.shape
    place, axes = view.place, view.axes
    sand_lod, fine_lod = np.float32(math.log2(sand.texel)), np.float32(math.log2(fine.texel))
    scale, pixel = _ENTRIES / _FARTHEST, 1.0 / view.focal
    ground, _, _, _ = surface(grid, place[0], place[1])
    line_depth = place[2] - ground
    for row in range(height):
        y = (row - view.center_y) * pixel
        line_x, line_y = axes[0, 1] * y + axes[0, 2], axes[1, 1] * y + axes[1, 2]
        line_z = axes[2, 1] * y + axes[2, 2]
        depth, growth = line_depth, 0.0
        for column in range(width):
            before, x = depth, (column - view.center_x) * pixel
            dx, dy, dz = axes[0, 0] * x + line_x, axes[1, 0] * x + line_y, axes[2, 0] * x + line_z
            shade, gap, depth = 1.0, 1.0, depth + growth
            for _ in range(_STILL):
                level, slope_x, slope_y, shade = surface(grid, place[0] + depth * dx, place[1] + depth * dy)
                gap = place[2] + depth * dz - level
                depth -= gap / min(dz - slope_x * dx - slope_y * dy, -0.15)
                if abs(gap) < _CLOSE:
                    break
            if not 0.0 < depth < _FARTHEST or abs(gap) > _CLOSE:
                depth = _first_hit(grid, place, dx, dy, dz)
                if depth <= 0.0:
                    return False
                _, _, _, shade = surface(grid, place[0] + depth * dx, place[1] + depth * dy)
                growth, before = 0.0, depth
            if column == 0:
                line_depth = depth
            else:
                growth = depth - before
            px, py = place[0] + depth * dx, place[1] + depth * dy
            entry = int(depth * scale)
            footprint = optics.lod[entry]
            grey = blended_texture(sand, px, py, footprint - sand_lod)
            detail = footprint - fine_lod
            if detail < 3.0:
                weight = min(np.float32(1.0), (np.float32(3.0) - detail) / np.float32(_FADE))
                grey += weight * (blended_texture(fine, px, py, detail) - np.float32(128.0))
            seen = grey * shade * optics.light[row, column] * optics.clear[entry]
            seen += optics.veil[row, column] * (np.float32(1.0) - optics.clear[entry])
            if optics.noise > 0.0:
                seen += optics.noise * normal(stream)
            image[row, column] = np.uint8(min(max(seen + 0.5, 0.0), 255.0))
    return True


def downward_pose(x: float, y: float, z: float, heading: float, pitch: float = 0.0, roll: float = 0.0) -> Floats:
    """The pose (4, 4), camera to world, of a camera that looks down with the image's top ahead.

    Args:
        x: [m].
        y: [m].
        z: Up [m].
        heading: Of the vehicle, from x towards y [rad].
        pitch: Nose down [rad].
        roll: Right side down [rad].
    """
    c, s = math.cos(heading), math.sin(heading)
    turned = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = math.cos(pitch), math.sin(pitch)
    nodded = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    c, s = math.cos(roll), math.sin(roll)
    rolled = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    mounted = np.array([[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    pose = np.eye(4)
    pose[:3, :3] = turned @ nodded @ rolled @ mounted
    pose[:3, 3] = x, y, z
    return pose
