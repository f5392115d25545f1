"""What the package offers by name, without loading it before it is asked for."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lidarena import slam
from lidarena.slam.logs.carmen import save_log
from tests.slam.logs.test_mapping import LOG


def test_every_name_is_there() -> None:
    for name in slam.__all__:
        assert getattr(slam, name) is not None and name in dir(slam)
    with pytest.raises(AttributeError, match="map_logs"):
        slam.map_logs  # noqa: B018


def test_a_file_is_mapped_as_the_log_that_it_holds(tmp_path: Path) -> None:
    path = save_log(tmp_path / "walk.log", LOG)
    assert np.array_equal(slam.map_log(path).poses, slam.map_log(slam.read_log(path)).poses)


def test_importing_it_loads_neither_torch_nor_matplotlib() -> None:
    code = "import sys; from lidarena import slam; assert not {'torch', 'matplotlib'} & sys.modules.keys()"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
