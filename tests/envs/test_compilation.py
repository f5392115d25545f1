import time
from typing import Any

import numba
import pytest
from numba.core.event import end_event, start_event

from lidarena.envs import compilation
from lidarena.envs.compilation import announced_compilation, keep_quiet


@pytest.fixture(autouse=True)
def short_patience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compilation, "_PATIENCE", 0.05)
    monkeypatch.setattr(compilation, "_told", False)


def compile_for(seconds: float) -> None:
    """Let numba say that it compiles a function of this module."""

    @numba.njit
    def slow(x: Any) -> Any:
        return x

    start_event("numba:compile", {"dispatcher": slow})
    time.sleep(seconds)
    end_event("numba:compile", {"dispatcher": slow})


def test_what_compiles_long_is_announced_once_by_name(capfd: pytest.CaptureFixture[str]) -> None:
    with announced_compilation():
        compile_for(0.4)
    with announced_compilation():
        compile_for(0.4)
    said = capfd.readouterr()
    assert said.err.count("compiling tests.envs.test_compilation and what it calls") == 1 and not said.out


def test_what_takes_long_without_compiling_says_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    with announced_compilation():
        time.sleep(0.3)
    assert capfd.readouterr().err == ""


def test_what_is_quick_says_nothing_even_if_it_fails(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ZeroDivisionError), announced_compilation():
        compile_for(0.0)
        1 / 0  # noqa: B018
    time.sleep(0.2)
    assert capfd.readouterr().err == ""


def test_a_worker_keeps_quiet(capfd: pytest.CaptureFixture[str]) -> None:
    keep_quiet()
    with announced_compilation():
        compile_for(0.3)
    assert capfd.readouterr().err == ""
