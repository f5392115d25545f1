"""The keyword `observation` of every family: names, and observers from outside of the package."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import yaml
from gymnasium.utils.env_checker import check_env

from lidarena.base.errors import ConfigError, ObservationError
from lidarena.envs import corridor_v0
from lidarena.envs.exploration.observations import scaled_covariance
from lidarena.envs.exploration.options import OBSERVATIONS, keywords_of_0_1
from lidarena.envs.registration import keywords_of_version_0_1
from tests.envs.own_observers import READY, Curious, InParts, Nearest, made

HERE = "tests.envs.own_observers"
FAMILIES: dict[str, tuple[str, dict[str, Any]]] = {
    "exploration": ("lidarena/Env1-v0", {"slam": "truth", "max_episode_steps": 12}),
    "arena": ("lidarena/Arena-v0", {"arena": "random", "max_episode_steps": 12}),
    "corridor": ("lidarena/CorridorCentral-v0", {"robots": 3, "max_episode_steps": 12}),
}


def equal(one: Any, other: Any) -> bool:
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(equal(one[name], other[name]) for name in one)
    return np.asarray(one).dtype == np.asarray(other).dtype and np.array_equal(one, other)


def part(batch: Any, world: int) -> Any:
    return {name: value[world] for name, value in batch.items()} if isinstance(batch, dict) else batch[world]


@pytest.mark.parametrize(
    "observation", [Nearest(), InParts(), Nearest, made, f"{HERE}:READY", f"{HERE}:made"], ids=range(6)
)
@pytest.mark.parametrize("family", FAMILIES)
def test_a_strangers_observer_shows_the_same_in_a_batch_to_the_bit(family: str, observation: Any) -> None:
    if family == "corridor" and isinstance(observation, InParts):
        pytest.skip("a team's observers give boxes")
    id_, keywords = FAMILIES[family]
    batch = gym.make_vec(id_, 2, vectorization_mode="vector_entry_point", **keywords, observation=observation)
    singles = [gym.make(id_, **keywords, observation=observation) for _ in range(2)]
    batch.action_space.seed(0)
    seen, _ = batch.reset(seed=5)
    assert batch.observation_space.contains(seen)
    assert all(equal(part(seen, w), env.reset(seed=5 + w)[0]) for w, env in enumerate(singles))
    for _ in range(15):
        actions = batch.action_space.sample()
        seen, _, _, _, infos = batch.step(actions)
        for world, env in enumerate(singles):
            own, _, *ends, _ = env.step(actions[world])
            if any(ends):
                assert equal(infos["final_obs"][world], own)
                own, _ = env.reset()
            assert equal(part(seen, world), own)


@pytest.mark.parametrize("family", FAMILIES)
def test_gymnasium_finds_nothing_to_complain_about(family: str) -> None:
    id_, keywords = FAMILIES[family]
    check_env(gym.make(id_, **keywords, observation=f"{HERE}:Nearest").unwrapped, skip_render_check=True)


def test_agents_of_a_team_see_what_a_stranger_makes_of_it() -> None:
    fleet = corridor_v0.parallel_env(robots=2, **yaml.safe_load(f"observation: '{HERE}:Nearest'"))
    observations, infos = fleet.reset(seed=0)
    for name, seen in observations.items():
        assert fleet.observation_space(name) == Nearest.space
        assert seen.tolist() == [infos[name]["scan"].min(), 0.0, 0.0]
    assert fleet.state().shape == (2, 3)


def test_robots_that_share_a_policy_too() -> None:
    batch = gym.make_vec(
        "lidarena/CorridorShared-v0", 4, vectorization_mode="vector_entry_point", robots=2, observation=Nearest()
    )
    assert batch.reset(seed=0)[0].shape == (4, 3)


@pytest.mark.parametrize("family", FAMILIES)
def test_nobody_is_shown_the_truth(family: str) -> None:
    id_, keywords = FAMILIES[family]
    env = gym.make(id_, **keywords, expose_truth=True, observation=Curious())
    assert "truth" in env.reset(seed=0)[1]


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ("da_slm", "observation = 'da_slm' is not known; did you mean 'da_slam'"),
        (3, "observation = 3 must have a space and observe"),
        (f"{HERE}:Neares", "has no 'Neares'; did you mean 'Nearest'"),
        (f"{HERE}:looked", "cannot be made without arguments"),
        (f"{HERE}:Shapeless", "has the space Text.*; allowed are Box, Discrete"),
        (None, "observation = None must have a space"),
    ],
)
def test_bad_observers_are_refused_when_the_environment_is_made(spec: Any, message: str) -> None:
    with pytest.raises(ConfigError, match=message) as refusal:
        gym.make("lidarena/Env1-v0", observation=spec)
    assert "\n" not in str(refusal.value)


def test_a_team_takes_boxes_only() -> None:
    with pytest.raises(ConfigError, match=r"has the space Dict.*; allowed are Box$"):
        corridor_v0.parallel_env(observation=InParts())


def test_what_is_not_in_the_space_is_refused() -> None:
    env = gym.make("lidarena/Arena-v0", observation=f"{HERE}:Wrong")
    with pytest.raises(ObservationError, match=r"'Wrong' gave array.* of float32 \(2,\), which is not in"):
        env.reset(seed=0)


def test_an_observer_is_used_as_it_is() -> None:
    env = gym.make("lidarena/Arena-v0", observation=f"{HERE}:READY")
    assert env.observation_space is READY.space


@pytest.mark.parametrize("kind", ["da_slam", "sectors", "frontier_histogram", "frontier_arcs"])
def test_with_the_entropy_only_the_last_entry_is_another(kind: str) -> None:
    plain, entropy = (gym.make("lidarena/Env1-v0", observation=name) for name in (kind, f"{kind}_entropy"))
    assert plain.observation_space == entropy.observation_space
    plain.reset(seed=1), entropy.reset(seed=1)
    for action in (0, 1, 0, 0):
        (one, _, _, _, info), (other, *_) = plain.step(action), entropy.step(action)
        assert np.array_equal(one[:-1], other[:-1])
        assert one[-1] == np.float32(info["completeness"])
        assert other[-1] == pytest.approx(info["entropy"] / np.log(30), abs=1e-6)


def test_the_name_of_version_0_1_still_means_the_histogram() -> None:
    with pytest.warns(DeprecationWarning, match="observation = 'compass' is called 'frontier_histogram' now"):
        env = gym.make("lidarena/Env1-v0", observation="compass")
    assert env.unwrapped.options.observation == "frontier_histogram"


def test_d_optimality_without_an_observation_says_what_is_seen_now() -> None:
    with pytest.warns(DeprecationWarning, match="'da_slam' tells the completeness whatever the reward"):
        gym.make("lidarena/Env1-v0", reward="d_optimality")


@pytest.mark.parametrize("seen", [None, "da_slam", "sectors", "compass", "map"])
def test_keywords_of_version_0_1_see_what_they_saw(seen: str | None) -> None:
    keywords = {"reward": "d_optimality"} | ({} if seen is None else {"observation": seen})
    now = {None: "da_slam_entropy", "compass": "frontier_histogram_entropy", "map": "map"}.get(seen, f"{seen}_entropy")
    if seen == "map":
        assert keywords_of_0_1(keywords) == keywords
        return
    with pytest.warns(DeprecationWarning):
        assert keywords_of_0_1(keywords)["observation"] == now
    assert now in OBSERVATIONS


def test_keywords_of_version_0_1_are_looked_up_by_the_environments_id() -> None:
    with pytest.warns(DeprecationWarning, match="da_slam_entropy"):
        modern = keywords_of_version_0_1("lidarena/Env1-v0", {"reward": "d_optimality"})
    assert modern == {"reward": "d_optimality", "observation": "da_slam_entropy"}
    with pytest.warns(DeprecationWarning, match="turn_weight"):
        modern = keywords_of_version_0_1("lidarena/Arena-v0", {"turn_weight": 2})
    assert modern == {"reward": {"preset": "default", "turn": 2}}
    assert keywords_of_version_0_1("somebody/Elses-v0", {"turn_weight": 2}) == {"turn_weight": 2}


def test_covariances_are_scaled_to_what_a_network_reads() -> None:
    deviations, correlation = np.array([1e-3, 0.1, 10.0]), np.array([[1, 0.5, 0], [0.5, 1, -1], [0, -1, 1]])
    seen = scaled_covariance((deviations[:, None] * deviations * correlation)[None])[0]
    assert seen == pytest.approx([0.0, 0.5, 1.0, 0.5, 0.0, -1.0], abs=1e-6) and seen.dtype == np.float32
    assert scaled_covariance(np.zeros((2, 3, 3))).tolist() == [[0.0] * 6] * 2
    assert scaled_covariance(np.eye(3)[None] * 1e12)[0].tolist() == [1.0] * 3 + [0.0] * 3


def test_covariances_do_not_depend_on_the_size_of_the_batch() -> None:
    rng = np.random.default_rng(0)
    parts = rng.normal(size=(37, 3, 3)) * 1e-2
    many = parts @ parts.transpose(0, 2, 1)
    together = scaled_covariance(many)
    assert np.array_equal(together, np.concatenate([scaled_covariance(one[None]) for one in many]))
    assert (np.abs(together) <= 1.0).all()


def test_an_observer_of_ones_own_is_not_bound_to_the_beams_of_another() -> None:
    """DA-SLAM's observation shows a beam at 45 degrees, which this lidar has not."""
    env = gym.make("lidarena/Env1-v0", observation=Nearest, lidar={"beams": 4}, max_episode_steps=5)
    assert env.observation_space.contains(env.reset(seed=0)[0])
