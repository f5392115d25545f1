from pathlib import Path

from lidarena.agents import train
from tests.agents.training_cases import curve, equal, small, weights


def test_real_worlds_go_on_to_the_bit(tmp_path: Path) -> None:
    overrides = ("env.id=lidarena/Env1-v0", "env.keywords={particles: 5, max_episode_steps: 20}", "num_envs=2")
    straight = train(small(tmp_path / "straight", *overrides, "total_steps=96"), progress=False)
    stopped = train(small(tmp_path / "stopped", *overrides, "total_steps=32"), progress=False)
    resumed = train(small(stopped, *overrides, "total_steps=96"), resume=stopped, progress=False)
    assert equal(weights(resumed), weights(straight)) and curve(resumed) == curve(straight)
    assert curve(resumed)[-1]["completeness"]


def test_arenas_go_on_to_the_bit(tmp_path: Path) -> None:
    keywords = "env.keywords={arena: random, arenas: 5, action: discrete, max_episode_steps: 12}"
    overrides = ("env.id=lidarena/Arena-v0", keywords, "num_envs=3", "ppo.batch_size=16")
    straight = train(small(tmp_path / "straight", *overrides, "total_steps=144"), progress=False)
    stopped = train(small(tmp_path / "stopped", *overrides, "total_steps=48"), progress=False)
    resumed = train(small(stopped, *overrides, "total_steps=144"), resume=stopped, progress=False)
    assert equal(weights(resumed), weights(straight)) and curve(resumed) == curve(straight)
    assert curve(resumed)[-1]["success_rate"] == "0" and not curve(resumed)[-1]["completeness"]


def test_worlds_that_cannot_be_written_down_start_over(tmp_path: Path) -> None:
    config = small(tmp_path / "run", "env.id=fakebatch/Stranger-v0", "total_steps=128")
    folder = train(config, progress=False)
    train(resume=folder, config=config.model_copy(update={"total_steps": 256}), progress=False)
    assert [int(row["step"]) for row in curve(folder)] == [64, 128, 192, 256]
