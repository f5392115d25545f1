"""The learners' blocks: the libraries' names and defaults, and who may have which block."""

import inspect
from pathlib import Path

import pytest

from lidarena.agents.learner_config import BLOCKS, ON_POLICY, Algorithm
from lidarena.agents.learners import LEARNERS
from lidarena.agents.networks import SIZES, network_class
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import check_config, dump_config, load_config


def check(*overrides: str) -> TrainingConfig:
    return check_config({"env": "lidarena/Env1-v0"}, TrainingConfig, overrides)


@pytest.mark.parametrize("algorithm", BLOCKS)
def test_names_and_defaults_are_the_librarys(algorithm: Algorithm) -> None:
    config = check(f"algorithm={algorithm}")
    own = inspect.signature(LEARNERS[algorithm].algorithm.__init__).parameters
    network = inspect.signature(network_class(algorithm, "MlpPolicy").__init__).parameters
    for name, value in config.learner:
        assert (network if name in SIZES.get(algorithm, ()) else own)[name].default == value, name
    assert config.policy.activation == ("tanh" if BLOCKS[algorithm] in ON_POLICY else "relu")
    default = network["activation_fn"].default.__name__.lower()
    assert default == config.policy.activation


@pytest.mark.parametrize("algorithm", BLOCKS)
def test_the_resolved_file_holds_the_block_of_the_learner_alone(algorithm: str, tmp_path: Path) -> None:
    config = check(f"algorithm={algorithm}")
    file = dump_config(config, tmp_path / "config.yaml")
    assert load_config(file, TrainingConfig) == config
    assert {*config.model_dump()} & {*BLOCKS.values()} == {BLOCKS[algorithm]}  # type: ignore[index]


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (["sac.gamma=0.9"], "'sac' is the block of SAC, but 'algorithm' is PPO, whose block is 'ppo'"),
        (["algorithm=SAC", "ppo.n_steps=3"], "'ppo' is the block of PPO, but 'algorithm' is SAC, whose block is 'sac'"),
        (["algorithm=ppo"], "'algorithm' is 'ppo', which is not known; did you mean 'PPO'? Allowed: MaskablePPO, PPO"),
        (["algorithm=SAC", "sac.gama=1"], "did you mean 'gamma'? Allowed: batch_size, buffer_size"),
        (["maskable_po.gamma=1"], "did you mean 'maskable_ppo'?"),
        (["algorithm=TQC", "tqc.n_quantiles=2"], "should be less than n_quantiles = 2"),
        (["algorithm=SAC", "policy.net_arch={pi: [3], vf: [3]}"], "but SAC takes {pi: […], qf: […]} or a list"),
        (["algorithm=QRDQN", "policy.net_arch={pi: [3]}"], "but QRDQN takes a list"),
        (["algorithm=SAC", "sac.ent_coef=auto_x"], "'sac.ent_coef' is 'auto_x'"),
        (["algorithm=SAC", "sac.buffer_size=3"], "'sac.buffer_size' is 3, but it should be at least num_envs = 64"),
        (["algorithm=QRDQN", "qrdqn.target_update_interval=2"], "it should be at least num_envs = 64"),
        (["algorithm=MaskablePPO", "maskable_ppo.batch_size=33"], "'maskable_ppo.batch_size' is 33, but it should div"),
        (["algorithm=RecurrentPPO", "recurrent_ppo.shared_lstm=true"], "set enable_critic_lstm: false"),
        (["algorithm=[PPO]"], "'algorithm' is ['PPO'], which is not known"),
    ],
)
def test_mistakes_are_named(overrides: list[str], message: str) -> None:
    with pytest.raises(ConfigError) as refusal:
        check(*overrides)
    assert message in str(refusal.value) and "\n" not in str(refusal.value)


def test_any_batch_size_goes_with_an_lstm() -> None:
    assert check("algorithm=RecurrentPPO", "recurrent_ppo.batch_size=33").learner.batch_size == 33
