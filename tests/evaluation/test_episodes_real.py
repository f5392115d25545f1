"""A few steps in the environments that the evaluation is for."""

import numpy as np
import pytest

from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import Episode, run_episode
from lidarena.evaluation.participants import make_participants
from lidarena.evaluation.trace import RobotTrace


def short_episode(policy: str, seed: int) -> Episode:
    env, driver = make_participants(EnvEntry(id="lidarena/Env1-v0"), PolicyEntry(name=policy))
    return run_episode(env, driver, seed, max_steps=25, keep_picture=True)


@pytest.mark.parametrize("policy", ["random", "frontier"])
def test_everything_is_measured(policy: str) -> None:
    episode = short_episode(policy, seed=3)
    seldom = ("entropy_gmapping", "path_at_95", "path_at_99")
    values = {name: value for name, value in episode.measures.items() if name not in seldom}
    assert np.isfinite(list(values.values())).all()
    assert 0 < values["completeness"] < 1 and 0 < values["path_length"] < 25 * 0.1 + 0.1
    assert values["time"] == pytest.approx(0.2 * values["steps"])
    assert 0 < values["trajectory_error"] < 0.2
    assert isinstance(episode.picture, RobotTrace) and episode.picture.belief is not None
    walked = np.hypot(*np.diff(episode.picture.true, axis=0).T).sum()
    assert walked == pytest.approx(values["path_length"], rel=0.02, abs=0.01)


def test_a_graph_reaches_the_trace() -> None:
    trace = short_episode("ealc", seed=3).picture
    assert isinstance(trace, RobotTrace) and trace.nodes.shape == (1, 2) and trace.links.shape == (0, 2)
    assert np.hypot(*(trace.nodes[0] - trace.true[0])) < 0.2
    plain = short_episode("random", seed=3).picture
    assert isinstance(plain, RobotTrace) and plain.nodes.shape == (0, 2)


def test_a_seed_fixes_an_episode() -> None:
    first, second = short_episode("random", 5), short_episode("random", 5)
    for one, other in ((first, second), (first, short_episode("random", 6))):
        same = np.array_equal(one.picture.true, other.picture.true)  # type: ignore[union-attr]
        assert same == (other is second)
