from pathlib import Path

from lidarena import agents
from lidarena.agents.exploration.goal_choice_env import GOAL_CHOICE_ID
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.yaml_config import check_config

MAZE = "maze:5?width=5&height=5"


def test_a_training_that_was_cut_off_goes_on_to_the_bit(tmp_path: Path) -> None:
    content = {
        "env": {"id": GOAL_CHOICE_ID, "keywords": {"map": MAZE, "max_episode_steps": 250, "particles": 5}},
        "num_envs": 2,
        "ppo": {"n_steps": 8, "batch_size": 16, "n_epochs": 1},
        "policy": {"class": "CandidatePolicy", "net_arch": [8]},
    }
    halves, whole = (
        check_config(content | {"total_steps": steps, "out": str(tmp_path / name)}, TrainingConfig)
        for steps, name in ((16, "halves"), (32, "whole"))
    )
    cut = agents.train(halves, progress=False)
    agents.train(halves.model_copy(update={"total_steps": 32, "out": str(cut)}), resume=cut, progress=False)
    left_alone = agents.train(whole, progress=False)
    assert (cut / "policy.safetensors").read_bytes() == (left_alone / "policy.safetensors").read_bytes()
