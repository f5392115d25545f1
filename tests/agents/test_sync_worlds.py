from pathlib import Path

import pytest

from lidarena.agents import train
from tests.agents.test_batches import RESTORABLE
from tests.agents.training_cases import curve, equal, small, weights


def test_single_worlds_that_can_be_written_down_go_on_to_the_bit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    env = f"env.id={RESTORABLE}"
    straight = train(small(tmp_path / "straight", env, "total_steps=256"))
    stopped = train(small(tmp_path / "stopped", env, "total_steps=128"))
    resumed = train(small(stopped, env, "total_steps=256"), resume=stopped)
    assert equal(weights(resumed), weights(straight)) and curve(resumed) == curve(straight)
    assert "lose" not in capsys.readouterr().out
