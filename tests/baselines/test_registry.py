import gymnasium as gym
import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.baselines import Policy, make, names, register
from lidarena.envs import ExplorationEnv
from lidarena.envs.registration import family_of
from tests.baselines.exploration.fake_exploration import FakeExploration, drawn


class Plain(gym.Env):
    def __init__(self, space=None):
        self.action_space = space or gym.spaces.Discrete(4)


class OfFamily(Plain):
    family = "arena"


def fake(**options):
    return FakeExploration(drawn("####", "#  #", "#  #", "####", side=20), (1.5, 1.5, 0.0), **options)


def test_names_are_known_and_every_one_can_be_made():
    assert {"frontier", "random"} <= set(names())
    assert names() == sorted(names())
    for name in ("frontier", "random"):
        assert isinstance(make(name, fake()), Policy)


def test_an_unknown_name_is_refused_with_the_nearest():
    with pytest.raises(ConfigError, match="unknown baseline 'fronteir'; did you mean 'frontier'"):
        make("fronteir", fake())


def test_an_unknown_option_is_refused_with_the_nearest():
    with pytest.raises(ConfigError, match="no option 'min_frontier_sise'; did you mean 'min_frontier_size'"):
        make("frontier", fake(), min_frontier_sise=1.0)
    with pytest.raises(ConfigError, match="'random' has no option 'seed'; it has no options"):
        make("random", fake(), seed=1)


@pytest.mark.parametrize("env", [Plain(), OfFamily()])
def test_another_family_is_refused(env):
    with pytest.raises(ConfigError, match=f"'frontier' drives exploration environments only, not {type(env).__name__}"):
        make("frontier", env)


def test_family_is_the_attribute_found_through_wrappers():
    class Own(gym.Env):
        def __init__(self, env):
            self.env = env

    assert family_of(OfFamily()) == family_of(Own(OfFamily())) == family_of(Own(Own(OfFamily()))) == "arena"
    assert family_of(Plain()) is None and family_of(Own(Plain())) is None
    env = Plain()
    env.spec = gym.envs.registration.EnvSpec("lidarena/Env3-v0")
    assert family_of(env) is None
    assert family_of(ExplorationEnv(map="env1")) == "exploration"
    assert family_of(gym.make("lidarena/Env1-v0")) == "exploration"


def test_own_policies_can_be_registered_once():
    @register("still-for-this-test", family="arena")
    class Still:
        def __init__(self, env, *, action=0):
            self.action = action

        def reset(self, seed=None):
            pass

        def act(self, observation, info):
            return self.action

    assert make("still-for-this-test", OfFamily(), action=2).act(None, {}) == 2
    with pytest.raises(ConfigError, match="registered already"):
        register("still-for-this-test")(lambda env: None)


@pytest.mark.parametrize("space", [gym.spaces.Discrete(3), gym.spaces.Box(-1, 1, (2,), np.float32)])
def test_random_is_reproducible_and_leaves_the_environment_alone(space):
    env = Plain(space)
    env.action_space.seed(1)
    expected = [env.action_space.sample() for _ in range(3)]
    env.action_space.seed(1)
    policy = make("random", env)
    runs = []
    for seed in (3, 3, 4):
        policy.reset(seed=seed)
        runs.append(np.array([policy.act(None, {}) for _ in range(40)]))
    np.testing.assert_array_equal(runs[0], runs[1])
    assert (runs[0] != runs[2]).any()
    assert all(space.contains(policy.act(None, {})) for _ in range(20))
    np.testing.assert_array_equal(np.array([env.action_space.sample() for _ in range(3)]), np.array(expected))


def test_random_is_uniform():
    policy = make("random", Plain(gym.spaces.Discrete(3)))
    policy.reset(seed=0)
    counts = np.bincount([policy.act(None, {}) for _ in range(3000)], minlength=3)
    assert (np.abs(counts - 1000) < 120).all()


def test_random_takes_the_space_of_one_world_of_a_batch():
    class Batch:
        single_action_space = gym.spaces.Discrete(3)
        action_space = gym.spaces.MultiDiscrete([3, 3])

    policy = make("random", Batch())
    policy.reset(seed=0)
    assert policy.act(None, {}) in (0, 1, 2)
