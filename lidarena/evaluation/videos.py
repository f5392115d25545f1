"""Videos of episodes, written frame by frame: MP4 by OpenCV, GIF by Pillow."""

from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from lidarena.base.errors import ConfigError, WriteError
from lidarena.evaluation.recording import Env

SPEED = 8
"""How many times faster than the simulated time a video plays."""

STEPS_PER_FRAME = 2
"""Rendering takes longer than a step, and at this speed nobody misses every other one."""

GIF_FRAMES = 300
GIF_WIDTH = 640


class VideoRecorder:
    """A video of one episode; a context manager that finishes the file when it ends.

    An MP4 is written frame by frame, so its length costs no memory. A GIF keeps at most `GIF_FRAMES` frames of at
    most `GIF_WIDTH` pixels: whenever there are more, every other one is dropped, and the rest is shown longer.

    Args:
        path: The file; ``.mp4`` or ``.gif``.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._writer: cv2.VideoWriter | None = None
        self._stills: list[Image.Image] = []
        self._stride = 1
        self._seen = 0
        self._count = 0
        self._fps = 20.0

    def __enter__(self) -> Self:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._writer is not None:
            self._writer.release()
            if kind is None and not cv2.VideoCapture(str(self.path)).isOpened():  # the writer itself says nothing
                raise WriteError(f"{str(self.path)!r} cannot be written: the disk is full, or the video is torn")
        if self._stills and kind is None:
            self._save_gif()

    def add(self, env: Env) -> None:
        """Append what the environment renders now, one time in `STEPS_PER_FRAME`.

        An environment whose steps last seconds has ``moments``, and renders each of them by ``render_at``.

        Raises:
            ConfigError: The environment renders nothing, or the file cannot be written.
        """
        world: Any = getattr(env, "unwrapped", env)
        moments = getattr(world, "moments", None)
        pictures = [env.render] if moments is None else [partial(world.render_at, time) for time in moments]
        for picture in pictures:
            self._seen += 1
            if (self._seen - 1) % STEPS_PER_FRAME == 0:
                self._append(env, picture())

    def _append(self, env: Env, frame: object) -> None:
        if not isinstance(frame, np.ndarray):
            raise ConfigError("'videos' is set, but an environment renders no pictures (render_mode 'rgb_array')")
        if self._count == 0:
            self._fps = SPEED / STEPS_PER_FRAME * float(env.metadata.get("render_fps", 5))
        if self.path.suffix == ".gif":
            self._add_to_gif(frame)
        else:
            self._add_to_mp4(frame)
        self._count += 1

    def _save_gif(self) -> None:
        duration = max(20, round(1000 * self._stride / self._fps))
        try:
            self._stills[0].save(self.path, save_all=True, append_images=self._stills[1:], duration=duration, loop=0)
        except OSError as error:
            raise WriteError(f"{str(self.path)!r} cannot be written: {error.strerror}") from error

    def _add_to_gif(self, frame: NDArray[np.uint8]) -> None:
        if self._count % self._stride:
            return
        still = Image.fromarray(frame)
        still.thumbnail((GIF_WIDTH, GIF_WIDTH))
        self._stills.append(still.quantize(64))
        if len(self._stills) > GIF_FRAMES:
            self._stills = self._stills[::2]
            self._stride *= 2

    def _add_to_mp4(self, frame: NDArray[np.uint8]) -> None:
        height, width = (side - side % 2 for side in frame.shape[:2])  # codecs want even sides
        if self._writer is None:
            code = cv2.VideoWriter.fourcc(*"mp4v")
            self._writer = cv2.VideoWriter(str(self.path), code, self._fps, (width, height))
            if not self._writer.isOpened():
                raise ConfigError(f"this OpenCV cannot write {self.path.name!r} as MP4; set 'videos' to gif or false")
        self._writer.write(np.ascontiguousarray(frame[:height, :width, ::-1]))
