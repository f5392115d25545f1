"""Videos can be played: right number of frames, right size, right colours."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import cv2
import numpy as np
import pytest
from PIL import Image

from lidarena.base.errors import ConfigError
from lidarena.evaluation.videos import GIF_FRAMES, GIF_WIDTH, VideoRecorder


def scene(width: int = 161, height: int = 81) -> Any:
    frame = np.zeros((height, width, 3), dtype=np.uint8)
    frame[..., 0] = 220  # red
    return SimpleNamespace(render=lambda: frame, metadata={"render_fps": 5})


def test_an_mp4_holds_every_other_step(tmp_path: Path) -> None:
    with VideoRecorder(tmp_path / "videos" / "film.mp4") as film:
        for _ in range(24):
            film.add(scene())
    video = cv2.VideoCapture(str(tmp_path / "videos" / "film.mp4"))
    frames = []
    while (answer := video.read())[0]:
        frames.append(answer[1])
    assert len(frames) == 12 and frames[0].shape == (80, 160, 3)
    assert video.get(cv2.CAP_PROP_FPS) == pytest.approx(20)
    blue, green, red = frames[0].mean(axis=(0, 1))
    assert red > 180 and blue < 60 and green < 60


@pytest.mark.parametrize("count", [14, 4 * GIF_FRAMES])
def test_a_gif_stays_small(tmp_path: Path, count: int) -> None:
    env = scene(2 * GIF_WIDTH, 40)
    with VideoRecorder(tmp_path / "film.gif") as film:
        for number in range(count):
            env.render()[:, : 1 + number % GIF_WIDTH, 1] = number % 256  # equal frames would be merged
            film.add(env)
    with Image.open(tmp_path / "film.gif") as image:
        assert image.size == (GIF_WIDTH, 20)
        assert 1 < image.n_frames <= GIF_FRAMES
        assert image.info["duration"] == (50 if count == 14 else 100)


def test_an_environment_that_renders_nothing_is_refused(tmp_path: Path) -> None:
    blind = SimpleNamespace(render=lambda: None, metadata={})
    with pytest.raises(ConfigError, match="renders no pictures"), VideoRecorder(tmp_path / "film.gif") as film:
        film.add(blind)
    assert not (tmp_path / "film.gif").exists()
