"""A scene is its number's, the ground lies as far below the flight as was asked for, and frames are computed once."""

import numpy as np
import pytest

from lidarena.envs.seabed.options import SeabedOptions
from lidarena.envs.seabed.scenes import SCENES, FrameStore, SceneKind, make_scene
from tests.envs.seabed.short_flights import SHORT

KIND = SceneKind((3.5, 7.0), 30.0, 4.0, 0.5)


def test_the_ground_is_as_far_below_as_the_scene_says() -> None:
    scene = make_scene(KIND, 2**31)
    clearances = [scene.clearance(frame) for frame in range(0, 101, 10)]
    assert min(clearances) > 3.2 and max(clearances) < 7.4
    assert SCENES["scene1"].clearance == (3.5, 7.0) and SCENES["scene2"].clearance == (1.0, 10.0)
    assert (SCENES["scene1"].duration, SCENES["scene2"].duration) == (180.0, 134.0)


def test_attitudes_are_measured_with_the_noise_that_was_asked_for() -> None:
    scene = make_scene(KIND, 2**31)
    off = [scene.attitude(n, 0.01) @ scene.flight.poses[n, :3, :3].T for n in range(101)]
    angles = [np.arccos(np.clip(0.5 * (np.trace(one) - 1.0), -1.0, 1.0)) for one in off]
    assert np.sqrt(np.mean(np.square(angles)) / 3.0) == pytest.approx(0.01, rel=0.15)
    assert np.allclose(scene.attitude(5, 0.0), scene.flight.poses[5, :3, :3])


def test_a_frame_is_computed_once_and_the_same_in_another_store() -> None:
    options = SeabedOptions.checked(SHORT)
    stores = [FrameStore(options.camera, options.water, options.odometry.features) for _ in range(2)]
    scene = make_scene(KIND, 2**31)
    one = stores[0].look(KIND, scene, 10)
    assert stores[0].look(KIND, scene, 10) is one
    assert np.array_equal(stores[1].look(KIND, scene, 10).pixels, one.pixels)
    assert not np.array_equal(stores[0].images(scene, 11)[0], stores[0].images(scene, 10)[0])
