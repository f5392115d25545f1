import time

import pytest

from lidarena.envs import compilation
from lidarena.envs.compilation import announced_compilation


@pytest.fixture(autouse=True)
def short_patience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compilation, "_PATIENCE", 0.05)


def test_what_takes_long_is_announced_once(capfd: pytest.CaptureFixture[str]) -> None:
    with announced_compilation():
        time.sleep(0.4)
    said = capfd.readouterr()
    assert said.err.count("compiling kernels") == 1 and not said.out


def test_what_is_quick_says_nothing_even_if_it_fails(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ZeroDivisionError), announced_compilation():
        1 / 0  # noqa: B018
    time.sleep(0.2)
    assert capfd.readouterr().err == ""
