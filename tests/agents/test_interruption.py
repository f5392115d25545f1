import signal
import threading
from pathlib import Path

import pytest

from lidarena.agents.interruption import TrainingStopped, stop_on_signal


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_first_signal_asks_and_the_second_one_interrupts(
    number: signal.Signals, capsys: pytest.CaptureFixture[str]
) -> None:
    before = signal.getsignal(number)
    with pytest.raises(KeyboardInterrupt), stop_on_signal() as request:
        assert not request.requested
        signal.raise_signal(number)
        assert request.requested
        signal.raise_signal(number)
    assert signal.getsignal(number) == before
    assert "Stopping after this update" in capsys.readouterr().err


def test_afterwards_signals_act_as_before() -> None:
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    with stop_on_signal():
        pass
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)] == before


def test_outside_the_main_thread_nothing_is_changed() -> None:
    before, seen = signal.getsignal(signal.SIGINT), []

    def work() -> None:
        with stop_on_signal() as request:
            seen.append((request.requested, signal.getsignal(signal.SIGINT)))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [(False, before)]


@pytest.mark.parametrize(("checkpoint", "says"), [(None, "no checkpoint yet"), (1000, "from step 1,000")])
def test_a_stopped_training_says_how_to_go_on(checkpoint: int | None, says: str) -> None:
    assert says in str(TrainingStopped(Path("runs/a"), 1234, checkpoint))
