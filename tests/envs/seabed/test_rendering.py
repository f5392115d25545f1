"""The picture shows both tracks and what the camera sees."""

import numpy as np

from lidarena.world.canvas import BLUE, GREEN, RED
from tests.envs.seabed.short_flights import made


def test_the_picture_shows_tracks_vehicle_and_features() -> None:
    env = made(render_mode="rgb_array")
    env.reset(seed=0)
    for _ in range(3):
        env.step(np.array([2, 0]))
    picture = env.render()
    assert isinstance(picture, np.ndarray) and picture.shape[2] == 3 and picture.dtype == np.uint8
    for colour in (GREEN, RED, BLUE):
        assert (np.abs(picture.astype(int) - colour).max(axis=2) < 60).sum() > 20
    assert made().render_mode is None
