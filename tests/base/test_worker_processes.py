"""Processes that work for another one."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from lidarena.base.worker_processes import worker_pool

PROGRAM = """
import os, sys, time
sys.path.insert(0, {root!r})
from tests.base.test_worker_processes import tell_and_sleep
from lidarena.base.files import write_folder
from lidarena.base.worker_processes import worker_pool

def fill(place):
    with worker_pool(2) as pool:
        list(pool.map(tell_and_sleep, [{folder!r}] * 2))

if __name__ == "__main__":
    write_folder({out!r}, fill)
"""


def tell_and_sleep(folder: str) -> None:
    (Path(folder) / str(os.getpid())).touch()
    time.sleep(600)


def prepare() -> None:
    os.environ["LIDARENA_TEST_PREPARED"] = "yes"


def prepared(_: int) -> str:
    return os.environ.get("LIDARENA_TEST_PREPARED", "no")


def test_processes_are_prepared() -> None:
    with worker_pool(1, prepare) as pool:
        assert list(pool.map(prepared, range(2))) == ["yes", "yes"]
    assert prepared(0) == "no"


def is_running(process: int) -> bool:
    status = Path(f"/proc/{process}/stat")
    return status.exists() and ") Z " not in status.read_text()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
def test_processes_end_with_the_one_that_was_killed(tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    pids = tmp_path / "pids"
    pids.mkdir()
    program.write_text(PROGRAM.format(root=str(Path(__file__).parents[2]), folder=str(pids), out=str(tmp_path / "out")))
    started = subprocess.Popen([sys.executable, str(program)])
    try:
        workers = wait_for(lambda: [int(path.name) for path in pids.iterdir()], 2)
        assert len(workers) == 2 and all(is_running(worker) for worker in workers)
    finally:
        started.send_signal(signal.SIGKILL)
        started.wait()
    assert wait_for(lambda: [worker for worker in workers if not is_running(worker)], 2) == workers
    assert {path.name for path in tmp_path.iterdir()} == {"program.py", "pids"}  # nor is what was begun left behind


def wait_for(what, count: int) -> list[int]:  # type: ignore[no-untyped-def]
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline:
        found = sorted(what())
        if len(found) == count:
            return found
        time.sleep(0.1)
    raise AssertionError("waited in vain")
