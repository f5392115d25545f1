"""Nothing leaks: what the robot is told comes from its sensors, never from where it really is."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lidarena.envs import ExplorationEnv
from lidarena.envs.exploration.state import ExplorationCore
from lidarena.slam.rbpf.estimator import ParticleFilterEstimator
from lidarena.world.sensors import sense

ACTIONS = [0] * 8 + [1] * 8 + [0] * 8 + [2] * 8


def flat(prefix: str, value: Any) -> dict[str, np.ndarray]:
    if isinstance(value, dict):
        return {name: array for key, item in value.items() for name, array in flat(f"{prefix}.{key}", item).items()}
    return {prefix: np.asarray(value).copy()}


def sense_then_filter(core: ExplorationCore, shift: tuple[float, float, float]) -> Callable[..., None]:
    """What the kernel does in one go, in two: the true pose is moved after the sensors were read."""

    def perceive(first: int, last: int, active: np.ndarray) -> None:
        assert isinstance(core.estimator, ParticleFilterEstimator)
        sensors, filters = core.sensors, core.estimator.filters
        sense(0, core._sensing)
        core.physics.poses += shift
        filters.step(0, core.options.decision_period, sensors.readings[0, 0], sensors.scans[0, 0], core.streams[0])

    return perceive


def episode(shift: tuple[float, float, float] | None, **keywords: Any) -> list[dict[str, np.ndarray]]:
    """An episode in which, if ``shift`` is given, the true pose is moved whenever the sensors were read."""
    env = ExplorationEnv(map="env3", expose_truth=True, **keywords)
    observation, info = env.reset(seed=0)
    core = env.episodes.core
    if shift is not None:
        core._perceive = sense_then_filter(core, shift)  # type: ignore[method-assign]
    record = [flat("observation", observation) | flat("info", info)]
    for action in ACTIONS:
        observation, reward, terminated, _, info = env.step(action)
        if shift is not None:
            core.physics.poses -= shift
        assert not terminated
        record.append(flat("observation", observation) | flat("info", info) | flat("reward", reward))
    return record


@pytest.mark.parametrize(
    "observation", ["da_slam", "da_slam_entropy", "sectors", "frontier_histogram", "frontier_arcs", "map"]
)
@pytest.mark.parametrize("reward", ["completeness", "d_optimality"])
def test_shifting_the_truth_unnoticed_changes_nothing_but_the_truth(observation: str, reward: str) -> None:
    honest = episode(None, observation=observation, reward=reward)
    shifted = episode((4.0, -2.0, 1.0), observation=observation, reward=reward)
    for before, after in zip(honest, shifted, strict=True):
        changed = {name for name in before if before[name].tobytes() != after[name].tobytes()}
        assert changed <= {"info.truth.pose"}
    truths = [[infos["info.truth.pose"].tobytes() for infos in run] for run in (honest, shifted)]
    assert truths[0] != truths[1]


def test_truth_is_given_only_when_asked_for() -> None:
    assert "truth" not in ExplorationEnv(map="env1").reset(seed=0)[1]
    assert set(ExplorationEnv(map="env1", expose_truth=True).reset(seed=0)[1]["truth"]) == {"pose", "path_length"}


def test_the_estimate_is_not_the_truth_and_the_filter_follows_the_seed() -> None:
    clouds = []
    for seed in (1, 1, 2):
        env = ExplorationEnv(map="env2", expose_truth=True)
        env.reset(seed=seed)
        for _ in range(6):
            *_, info = env.step(0)
        assert not np.array_equal(info["pose"], info["truth"]["pose"])
        clouds.append(info["pose"].tobytes())
    assert clouds[0] == clouds[1] != clouds[2]


def test_inner_walls_stop_the_robot() -> None:
    env = ExplorationEnv(map="env1", expose_truth=True, stop_at=None)
    plan = env.episodes.core.plans[0]
    for seed in range(6):
        _, info = env.reset(seed=seed)
        rng, ended = np.random.default_rng(seed), False
        while not ended:
            *_, ended, truncated, info = env.step(int(rng.choice([0, 0, 0, 1, 2])))
            assert plan.clearance(info["truth"]["pose"][None, :2])[0] > 0.0
            ended = ended or truncated
