"""A finished run that tests may damage."""

import shutil
from pathlib import Path

import pytest

from lidarena.agents import train
from tests.agents.training_cases import small


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return train(small(tmp_path_factory.mktemp("finished") / "run", "total_steps=128"), progress=False)


@pytest.fixture
def run(finished: Path, tmp_path: Path) -> Path:
    """A run that a test may damage; a longer `total_steps` lets it go on."""
    return Path(shutil.copytree(finished, tmp_path / "run"))
