"""Any environment of Gymnasium's trains, also a stranger's without a batch of its own."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from lidarena.agents import load, train
from lidarena.agents.batches import make_batch
from lidarena.agents.sync_worlds import SyncWorlds
from lidarena.agents.training_config import EnvironmentConfig
from tests.agents.fake_batch import RestorableLineBatch
from tests.agents.training_cases import curve, small

WALK, RESTORABLE = (f"tests.agents.fake_single:stranger/{name}-v0" for name in ("Walk", "Restorable"))


@pytest.mark.parametrize(
    ("env_id", "kind"),
    [
        (WALK, SyncWorlds),
        ("CartPole-v1", SyncWorlds),  # whose own batch restarts one step later
        ("tests.agents.fake_batch:fakebatch/Line-v0", RestorableLineBatch),
    ],
)
def test_the_batch_is_the_environments_own_or_made_of_single_worlds(env_id: str, kind: type[Any]) -> None:
    batch = make_batch(EnvironmentConfig(id=env_id), 3)
    assert type(batch.env.unwrapped) is kind
    assert batch.env.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    assert batch.reset().shape[0] == 3
    batch.close()


@pytest.mark.parametrize("env_id", [WALK, "CartPole-v1"])
def test_strangers_train_and_lose_no_more_than_their_episodes(
    tmp_path: Path, env_id: str, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = train(small(tmp_path / "run", f"env.id={env_id}", "total_steps=128"))
    assert "a resumption will lose the worlds' running episodes" in capsys.readouterr().out
    train(small(folder, f"env.id={env_id}", "total_steps=256"), resume=folder)
    assert "lost:     the worlds' running episodes" in capsys.readouterr().out
    rows = curve(folder)
    assert [int(row["step"]) for row in rows] == [64, 128, 192, 256]
    assert bool(rows[-1]["success_rate"]) == bool(rows[-1]["collision_rate"]) == (env_id == WALK)
    policy = load(folder)
    assert policy.act(policy.observation_space.sample()) in (0, 1)


def test_masks_of_single_worlds_reach_the_learner(tmp_path: Path) -> None:
    overrides = (f"env.id={WALK}", "env.keywords={masked: true}", "algorithm=MaskablePPO", "total_steps=64")
    config = small(tmp_path / "run", *overrides, "ppo=", "maskable_ppo={n_steps: 16, batch_size: 32}")
    batch = make_batch(config.env, 2)
    batch.reset()
    assert np.array_equal(batch.env_method("action_masks"), [[False, True]] * 2)
    assert batch.has_attr("action_masks") and not batch.has_attr("something_else")
    env = make_batch(config.env, 1).env.envs[0]  # type: ignore[attr-defined]
    env.reset()
    policy = load(train(config, progress=False), env)
    assert policy.act(np.zeros(2, np.float32), {}) == 1


@pytest.mark.parametrize("keywords", [{"size": 3}, {"masked": True, "nonsense": 1}])
def test_keywords_of_strangers_are_refused_in_one_sentence(keywords: dict[str, Any]) -> None:
    from lidarena.base.errors import ConfigError

    with pytest.raises(ConfigError, match=r"cannot be made: .*unexpected keyword argument") as refusal:
        make_batch(EnvironmentConfig(id=WALK, keywords=keywords), 2)
    assert "\n" not in str(refusal.value)
