"""Estimators of one's own as a batch: what they are told, what is taken over, and what is refused."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import EstimatorError
from lidarena.envs import BatchedExploration, ExplorationEnv
from lidarena.slam.uncertainty import COVARIANCE_FLOOR, d_optimality
from lidarena.slam.world_estimators import WorldEstimators
from tests.slam.ray_mapper import RayMapper, SavedMapper

KEYWORDS: dict[str, Any] = {"map": "env1", "max_episode_steps": 30}
ACTIONS = [0, 0, 1, 0, 2, 0]


def estimators(env: Any) -> WorldEstimators:
    made = env.episodes.core.estimator
    assert isinstance(made, WorldEstimators)
    return made


def test_an_estimator_is_told_what_was_measured_and_nothing_else() -> None:
    env = ExplorationEnv(slam=RayMapper, **KEYWORDS)
    env.reset(seed=0)
    sensors, own = env.episodes.core.sensors, estimators(env).each[0]
    assert isinstance(own, RayMapper)
    for k, action in enumerate([0, *ACTIONS]):
        if k:
            env.step(action)
        odometry, scan, time = own.told[-1]
        assert len(own.told) == k + 1 and time == pytest.approx(0.2 * k)
        assert np.array_equal(odometry, sensors.readings[0, 0]) and (k > 0 or not odometry.any())
        assert np.array_equal(scan, sensors.scans[0, 0]) and not np.shares_memory(scan, sensors.scans)
    assert np.allclose(np.exp(1j * own.lidar.angles), np.exp(1j * np.radians(np.arange(360))), atol=1e-12)
    assert own.lidar.max_range == 3.5


def test_what_it_believes_is_what_everybody_reads() -> None:
    env = ExplorationEnv(slam=RayMapper, **KEYWORDS)
    _, info = env.reset(seed=0)
    core, own = env.episodes.core, estimators(env).each[0]
    for action in ACTIONS:
        *_, info = env.step(action)
        floored = own.covariance + np.diag(COVARIANCE_FLOOR)
        assert info["pose"] == pytest.approx(own.pose) and np.array_equal(info["map"], own.map)
        assert np.array_equal(info["covariance"], floored) and info["d_optimality"] == d_optimality(floored)
        wanted = core.maps.wanted[0] > 0
        assert info["completeness"] == ((own.map >= 0) & wanted).sum() / wanted.sum()
    assert not {"entropy", "n_eff", "entropy_gmapping"} & set(info)
    assert not np.shares_memory(info["map"], own.map)


def test_its_heading_is_told_as_every_heading_is() -> None:
    class Dizzy(RayMapper):
        def update(self, odometry: np.ndarray, scan: np.ndarray, time: float) -> None:
            super().update(odometry, scan, time)
            self.pose[2] += 2 * np.pi

    _, info = ExplorationEnv(slam=Dizzy, **KEYWORDS).reset(seed=0)
    assert -np.pi < info["pose"][2] <= np.pi


def test_randomness_comes_from_the_world_alone() -> None:
    poses = []
    for seed, worlds in ((3, 1), (3, 4), (4, 1)):
        batch = BatchedExploration(worlds, slam=SavedMapper, **KEYWORDS)
        batch.reset(seed=seed)
        for _ in range(35):  # a second episode begins on the way
            infos = batch.step(np.zeros(worlds, np.int64))[4]
        poses.append(infos["pose"][0].tobytes())
    assert poses[0] == poses[1] != poses[2]


def test_one_that_can_be_saved_continues_to_the_bit() -> None:
    batches = [BatchedExploration(2, slam=SavedMapper, **KEYWORDS) for _ in range(2)]
    batches[0].reset(seed=0)
    for action in ACTIONS:
        batches[0].step(np.full(2, action))
    state = batches[0].get_state()
    for action in [2, 0, 1]:
        batches[0].step(np.full(2, action))  # what was saved is of before
    batches[0].set_state(state)
    batches[1].set_state(state)
    for _ in range(30):
        results = [batch.step(np.zeros(2, np.int64)) for batch in batches]
        for name in ("pose", "map", "covariance", "d_optimality", "completeness", "time"):
            assert np.array_equal(results[0][4][name], results[1][4][name]), name
        assert np.array_equal(results[0][0], results[1][0])


def test_one_that_cannot_be_saved_says_so_when_it_is_to_be_saved() -> None:
    batch = BatchedExploration(2, slam=RayMapper, **KEYWORDS)
    batch.reset(seed=0)
    assert not batch.restorable and BatchedExploration(2, slam=SavedMapper, **KEYWORDS).restorable
    with pytest.raises(EstimatorError, match=r"'RayMapper' has no get_state\(\) and set_state\(\), so its worlds"):
        batch.get_state()


class Mute:
    def __init__(self, lidar: Any) -> None: ...


class Timeless(RayMapper):
    def update(self, odometry: np.ndarray, scan: np.ndarray) -> None: ...  # type: ignore[override]


def spoilt(change: Callable[[Any], None]) -> type[RayMapper]:
    """An estimator that something is wrong with after its second update."""

    class Spoilt(RayMapper):
        def update(self, odometry: np.ndarray, scan: np.ndarray, time: float) -> None:
            super().update(odometry, scan, time)
            if time > 0.1:
                change(self)

    return Spoilt


def give(**attributes: Any) -> Callable[[Any], None]:
    return lambda own: own.__dict__.update(attributes)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (give(pose=np.array([0.0, np.nan, 0.0])), r"pose = \[0.0, nan, 0.0\] is not finite"),
        (give(pose=np.zeros(2)), r"pose has the shape \(2,\), not \(3,\)"),
        (give(pose="here"), r"pose = 'here' must be numbers of shape \(3,\)"),
        (give(covariance=np.zeros(3)), r"covariance has the shape \(3,\), not \(3, 3\)"),
        (give(covariance=-np.eye(3)), "is not symmetric with a diagonal of at least 0"),
        (give(covariance=np.triu(np.ones((3, 3)))), "is not symmetric"),
        (give(map=np.zeros((3, 4), np.int8)), r"map has the shape \(3, 4\), not \(\d+, \d+\) as the grid"),
        (lambda own: own.map.__setitem__((0, 0), 50), "map has a cell 50; -1"),
        (lambda own: own.__dict__.pop("pose"), r"has no attribute 'pose' after update\(\)"),
    ],
)
def test_a_belief_that_is_none_is_refused_in_one_sentence(change: Callable[[Any], None], told: str) -> None:
    env = ExplorationEnv(slam=spoilt(change), **KEYWORDS)
    env.reset(seed=0)
    with pytest.raises(EstimatorError, match=f"^slam estimator 'Spoilt'.* {told}") as refused:
        env.step(0)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("maker", "told"),
    [
        (Mute, r"'Mute' made a Mute, which has no method reset\(pose, grid\)"),
        (Timeless, r"'Timeless' has a method update that cannot be called as update\(odometry, scan, time\)"),
        (lambda lidar: None, "made None, which has no method"),
    ],
)
def test_what_is_no_estimator_is_refused_at_once(maker: Any, told: str) -> None:
    with pytest.raises(EstimatorError, match=told):
        ExplorationEnv(slam=maker, **KEYWORDS)


def test_two_worlds_cannot_share_one() -> None:
    one = RayMapper(None)
    with pytest.raises(EstimatorError, match="made the same object for two worlds"):
        BatchedExploration(2, slam=lambda lidar: one, **KEYWORDS)


def test_a_state_that_is_no_arrays_is_refused() -> None:
    class Talker(SavedMapper):
        def get_state(self) -> dict[str, Any]:
            return {"mood": "fine"}

    batch = BatchedExploration(1, slam=Talker, **KEYWORDS)
    batch.reset(seed=0)
    with pytest.raises(EstimatorError, match=r"get_state\(\)\['mood'\] = 'fine' is no array of numbers"):
        batch.get_state()
