"""Scenes of the seabed: which ground, which flight over it, and the frames that are taken, each computed once."""

from collections import OrderedDict
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.envs.seabed.flights import Flight, fly, survey_area
from lidarena.vision.camera import StereoCamera
from lidarena.vision.features import FeatureOptions, Features, Pair, detect
from lidarena.vision.rigid_motion import rotation_of
from lidarena.vision.seabed import Seabed, make_seabed
from lidarena.vision.seabed_renderer import render_pair
from lidarena.vision.water import Water

Floats = NDArray[np.float64]

RATE = 25.0
"""Frames a second (Bobkov et al.)."""
_KEPT = 1600
"""Frames whose features are kept, half a megabyte each at 600 × 400 pixels."""
_AT_HAND = 20
"""Scenes that are kept, 16 MB each."""


@dataclass(frozen=True)
class SceneKind:
    """What a scene is like.

    Attributes:
        clearance: Least and greatest distance to the ground [m].
        longest: Longest wavelength of the relief [m].
        duration: Of the flight [s].
        speed: [m/s].
    """

    clearance: tuple[float, float]
    longest: float
    duration: float
    speed: float


SCENES = {"scene1": SceneKind((3.5, 7.0), 30.0, 180.0, 0.5), "scene2": SceneKind((1.0, 10.0), 60.0, 134.0, 0.5)}
"""Bobkov et al.'s model scenes; they do not print the speed."""


@dataclass(frozen=True)
class Scene:
    """A ground and a flight over it.

    Attributes:
        number: Of the scene; all of it follows from that.
        seabed: The ground.
        flight: Over it.
    """

    number: int
    seabed: Seabed
    flight: Flight

    def clearance(self, frame: int) -> float:
        """Distance to the ground straight below [m]."""
        x, y, z = self.flight.poses[frame, :3, 3].tolist()
        return float(z - self.seabed.height(x, y))

    def attitude(self, frame: int, sigma: float) -> Floats:
        """The attitude (3, 3) as it is measured with this standard deviation about each axis [rad]."""
        return np.asarray(rotation_of(sigma * self.flight.attitudes[frame]) @ self.flight.poses[frame, :3, :3])


@lru_cache(maxsize=_AT_HAND)
def make_scene(kind: SceneKind, number: int) -> Scene:
    """Make scene ``number`` of a kind; the same number makes the same scene."""
    rng = np.random.default_rng(np.random.SeedSequence([number, 0x5EABED]))
    frames = round(kind.duration * RATE) + 1
    low, high = kind.clearance
    flight = fly(rng, frames, RATE, kind.speed, low)
    x, y = flight.planar[:, 0], flight.planar[:, 1]
    area = survey_area(kind.duration * kind.speed)
    area = min(area[0], x.min()), min(area[1], y.min()), max(area[2], x.max()), max(area[3], y.max())
    return Scene(number, make_seabed(rng, high - low, area, kind.longest), flight)


class FrameStore:
    """Frames of scenes: rendered and looked through when they are first asked for, and kept for a while.

    A frame depends on its scene and number alone, whoever asks for it and when.

    Args:
        camera: That takes them.
        water: It is taken through.
        features: How features are found.
    """

    def __init__(self, camera: StereoCamera, water: Water, features: FeatureOptions) -> None:
        self.camera, self.water, self.features = camera, water, features
        self._kept: OrderedDict[tuple[int, SceneKind, int], Features] = OrderedDict()

    def images(self, scene: Scene, frame: int) -> Pair:
        """The pair of pictures of a frame."""
        rng = np.random.default_rng(np.random.SeedSequence([scene.number, frame, 0xF4A3E]))
        return render_pair(scene.seabed, self.camera, scene.flight.poses[frame], self.water, seed_stream(rng))

    def look(self, kind: SceneKind, scene: Scene, frame: int) -> Features:
        """The features of a frame."""
        key = scene.number, kind, frame
        found = self._kept.get(key)
        if found is None:
            found = detect(self.images(scene, frame), self.camera, self.features)
            self._kept[key] = found
            if len(self._kept) > _KEPT:
                self._kept.popitem(last=False)
        else:
            self._kept.move_to_end(key)
        return found


@lru_cache(maxsize=4)
def frame_store(camera: StereoCamera, water: Water, features: FeatureOptions) -> FrameStore:
    """The store of this process for a camera, water and features."""
    return FrameStore(camera, water, features)
