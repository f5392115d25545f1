"""A folder of maps as one kind of world: one episode a map, each from the start that a file says."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import Field

from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import ConfigModel

SUFFIXES = (".yaml", ".yml", ".map")
"""Of ROS's map_server and of MovingAI."""


class MapCase(NamedTuple):
    """One map of a folder.

    Attributes:
        name: Of its file, without the suffix.
        keywords: Of the environment: ``map``, and ``start`` if a file says where.
    """

    name: str
    keywords: dict[str, Any]


class MapFolder(ConfigModel):
    """A folder of maps in a comparison file.

    Attributes:
        path: The folder; its maps are the ``.yaml`` files of ROS's map_server and the ``.map`` files of MovingAI.
        starts: JSON file with the start of every map, ``{"NAME": [x, y, theta], …}`` [m, m, rad], in the folder or by
            its path; the maps' own starts if left out.
    """

    path: str = Field(min_length=1)
    starts: str | None = None

    def cases(self, count: int | None = None) -> list[MapCase]:
        """Return the maps in the order of their names.

        Args:
            count: So many of them, spread evenly over the order; all if None.

        Raises:
            ConfigError: There is no such folder, no map in it, not so many, or the starts do not fit.
        """
        folder = Path(self.path)
        if not folder.is_dir():
            raise ConfigError(f"there is no folder of maps {self.path!r}")
        files = sorted(file for file in folder.iterdir() if file.suffix in SUFFIXES)
        if not files:
            raise ConfigError(f"the folder {self.path!r} holds no map; files *{', *'.join(SUFFIXES)} are maps")
        if count is not None and count > len(files):
            raise ConfigError(f"the folder {self.path!r} holds {len(files)} maps, so episodes = {count} are too many")
        starts = self._read_starts(folder)
        cases = [MapCase(file.stem, {"map": str(file)} | self._start(starts, file.stem)) for file in files]
        wanted = len(cases) if count is None else count
        return [cases[place * len(cases) // wanted] for place in range(wanted)]

    def _read_starts(self, folder: Path) -> Mapping[str, Any] | None:
        if self.starts is None:
            return None
        file = folder / self.starts if (folder / self.starts).exists() else Path(self.starts)
        try:
            content = json.loads(file.read_text(encoding="utf-8"))
        except OSError as error:
            raise ConfigError(f"starts {self.starts!r} of {self.path!r} cannot be read: {error.strerror}") from None
        except ValueError as error:
            raise ConfigError(f"starts {self.starts!r} of {self.path!r} are not valid JSON: {error}") from None
        if not isinstance(content, dict):
            raise ConfigError(f'starts {self.starts!r} of {self.path!r} must look like {{"NAME": [x, y, theta], …}}')
        return content

    def _start(self, starts: Mapping[str, Any] | None, name: str) -> dict[str, Any]:
        if starts is None:
            return {}
        if name not in starts:
            raise ConfigError(f"starts {self.starts!r} of {self.path!r} say nothing of map {name!r}")
        pose = starts[name]
        if not (isinstance(pose, list) and len(pose) == 3 and all(_is_number(value) for value in pose)):
            raise ConfigError(
                f"starts {self.starts!r} of {self.path!r} have {pose!r} for map {name!r}; [x, y, theta] is needed"
            )
        return {"start": tuple(float(value) for value in pose)}


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
