"""One episode: what the policy sees, what is measured, and why it ends."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena import baselines
from lidarena.base.errors import ConfigError
from lidarena.evaluation.episodes import policy_seed, run_episode, without_truth
from lidarena.evaluation.measures.exploration import MEASURES
from lidarena.evaluation.participants import make_env
from lidarena.evaluation.trace import RobotTrace
from tests.evaluation.fake_world import Crasher, Driver

CORRIDOR = "tests.evaluation.fake_world:fake/Corridor-v0"


class Spy(Driver):
    """Remembers what it was shown."""

    def act(self, observation: Any, info: dict[str, Any]) -> int:
        self.seen = [*getattr(self, "seen", []), set(info)]
        return super().act(observation, info)


class Turner(Driver):
    """Turns on the spot, as good as, and so finds nothing new in the end."""

    def act(self, observation: Any, info: dict[str, Any]) -> int:
        return 1


def test_a_batch_is_refused() -> None:
    envs = gym.make_vec("lidarena/Arena-v0", 2, "vector_entry_point")
    with pytest.raises(ConfigError, match="runs in a single environment, not in 2 at once"):
        run_episode(envs, Driver(envs), seed=0)


def test_the_truth_is_kept_from_the_policy() -> None:
    env = make_env(CORRIDOR, {})
    _, info = env.reset(seed=0)
    assert "truth" in info  # there is something to keep
    spy = Spy(env)
    run_episode(env, spy, seed=0)
    assert len(spy.seen) > 30
    assert all("truth" not in keys and "pose" in keys for keys in spy.seen)
    assert without_truth({"truth": 1, "pose": 2}) == {"pose": 2}


def test_measures_of_a_known_episode() -> None:
    env = make_env(CORRIDOR, {"slip": 0.0})
    episode = run_episode(env, Driver(env, back=0.0), seed=3)
    steps = 35  # from 0.3 m in steps of 0.1 m to 99.5% of 3.8 m
    values = episode.measures
    assert list(values) == [column.name for column in MEASURES.table] and episode.columns == MEASURES.table
    assert episode.seed == 3 and episode.ending == "success"
    assert (values["success"], values["collision"], values["steps"]) == (1.0, 0.0, steps)
    assert values["completeness"] == pytest.approx(1.0)
    assert values["path_length"] == pytest.approx(0.1 * steps)  # the truth's, not the info's own 0
    assert values["time"] == pytest.approx(0.2 * steps)
    assert values["trajectory_error"] == pytest.approx(0.0)
    assert values["odometry_error"] == pytest.approx(np.mean(0.1 * np.arange(steps + 1)))
    assert values["d_optimality"] == pytest.approx(np.exp(np.mean(np.log(1e-4 * np.arange(2, steps + 2)))))
    assert values["d_optimality_per_metre"] == pytest.approx(values["d_optimality"])  # it drives as far in every step
    assert (values["reached_95"], values["reached_99"]) == (1.0, 1.0)
    assert values["path_at_95"] == pytest.approx(3.4) and values["path_at_99"] == pytest.approx(3.5)
    assert 0.7 < values["explored_over_path"] < 0.9  # half of the corridor on average, then all of it
    assert values["entropy"] == 1.5 and np.isnan(values["entropy_gmapping"])
    assert values["return"] == pytest.approx(100 * (1 - 0.3 / 3.8))
    assert 0 < values["decision_time"] < 0.01


def test_the_environment_may_reuse_its_arrays() -> None:
    env = make_env(CORRIDOR, {})
    trace = run_episode(env, Driver(env), seed=1, keep_picture=True).picture
    assert isinstance(trace, RobotTrace)
    assert len(np.unique(trace.true[:, 0])) > 20
    assert trace.true.shape == trace.estimated.shape
    assert np.abs(trace.true - trace.estimated).max() > 0
    assert trace.belief is not None and trace.belief.cells.flags.owndata
    assert trace.walls.edges.shape == (8, 4) and trace.walls.circles.shape == (1, 3)


def test_progress_has_an_entry_per_step_and_one_for_the_reset() -> None:
    env = make_env(CORRIDOR, {})
    episode = run_episode(env, Driver(env), seed=1)
    assert episode.progress is not None
    points = episode.progress.points
    assert points.shape == (episode.measures["steps"] + 1, 2)
    assert (np.diff(points[:, 0]) > 0).all() and (np.diff(points[:, 1]) >= 0).all()
    assert episode.picture is None


def test_a_collision_is_no_success() -> None:
    env = make_env(CORRIDOR, {})
    episode = run_episode(env, Crasher(env), seed=0)
    assert episode.ending == "collision"
    assert (episode.measures["success"], episode.measures["collision"], episode.measures["steps"]) == (0.0, 1.0, 3.0)


def test_a_policy_may_declare_itself_finished() -> None:
    env = make_env(CORRIDOR, {})
    episode = run_episode(env, Driver(env, finish_at=11), seed=0)
    assert episode.ending == "policy finished"
    assert episode.measures["steps"] == 10 and episode.measures["success"] == 0.0


def test_a_policy_may_be_finished_at_once() -> None:
    env = make_env(CORRIDOR, {})
    values = run_episode(env, Driver(env, finish_at=1), seed=0).measures
    assert values["steps"] == 0 and values["return"] == 0.0
    assert values["d_optimality"] == pytest.approx(1e-4)


@pytest.mark.parametrize(("keywords", "steps"), [({"max_episode_steps": 7}, 7), ({}, 120)])
def test_time_runs_out(keywords: dict[str, int], steps: int) -> None:
    env = make_env(CORRIDOR, keywords)
    episode = run_episode(env, Driver(env, back=0.5), seed=0)
    assert episode.ending == "out of time" and episode.measures["steps"] == steps


@pytest.mark.parametrize(
    ("patience", "max_steps", "ending"),
    [(5.0, None, "out of patience"), (None, 40, "out of time"), (9.0, 40, "out of time")],
)
@pytest.mark.parametrize("most", [400, None, -1])
def test_patience_that_runs_out_is_told_from_time(
    patience: float | None, max_steps: int | None, ending: str, most: int | None
) -> None:
    env = make_env("lidarena/Env1-v0", {"patience": patience, "max_episode_steps": most, "slam": "truth"})
    episode = run_episode(env, Turner(env), seed=0, max_steps=max_steps)
    assert episode.ending == ending and episode.measures["steps"] < 400


@pytest.mark.parametrize(("most", "steps"), [(None, 120), (30, 30), (-1, 200)])
def test_no_limit_given_is_the_ids_own_and_minus_one_is_never(most: int | None, steps: int) -> None:
    env = make_env(CORRIDOR, {"max_episode_steps": most})
    assert run_episode(env, Turner(env), seed=0, max_steps=200).measures["steps"] == steps


@pytest.mark.parametrize("most", [0, -2, 1.5, "many"])
def test_a_limit_that_is_none_is_refused_in_one_sentence(most: object) -> None:
    with pytest.raises(ConfigError, match=r"^environment .* cannot be made: .*max_episode_steps|^max_episode_steps"):
        make_env("lidarena/Env1-v0", {"max_episode_steps": most})


def test_steps_can_be_limited() -> None:
    env = make_env(CORRIDOR, {})
    assert run_episode(env, Driver(env), seed=0, max_steps=4).measures["steps"] == 4


def test_an_environment_without_truth_leaves_out_what_needs_it() -> None:
    env = make_env(CORRIDOR, {"truth": False})
    episode = run_episode(env, Driver(env), seed=0, keep_picture=True)
    assert np.isnan([episode.measures[name] for name in ("path_length", "trajectory_error", "odometry_error")]).all()
    assert isinstance(episode.picture, RobotTrace) and episode.picture.true.shape == (0, 2)


def test_the_same_seed_gives_the_same_episode_and_another_one_another() -> None:
    def measured(seed: int) -> dict[str, float]:
        env = make_env(CORRIDOR, {})
        values = run_episode(env, Driver(env), seed=seed).measures
        return {name: value for name, value in values.items() if name not in ("decision_time", "entropy_gmapping")}

    assert measured(4) == measured(4) != measured(5)


def test_policy_and_environment_draw_from_different_streams() -> None:
    env = make_env(CORRIDOR, {})
    driver = Driver(env)
    run_episode(env, driver, seed=8, max_steps=1)
    assert driver.seed == policy_seed(8) != 8
    drawn = np.random.default_rng(policy_seed(8)).standard_normal(8)
    assert not np.allclose(drawn, np.random.default_rng(8).standard_normal(8))
    assert len({policy_seed(seed) for seed in range(1000)}) == 1000


def test_the_camera_sees_every_state() -> None:
    env = make_env(CORRIDOR, {}, "rgb_array")
    frames: list[Any] = []
    episode = run_episode(env, Driver(env), seed=0, record=lambda env: frames.append(env.render()))
    assert len(frames) == episode.measures["steps"] + 1
    finished: list[int] = []
    run_episode(env, Driver(env, finish_at=3), seed=0, record=lambda env: finished.append(1))
    assert len(finished) == 3


def test_a_whole_map_is_a_success_where_no_completeness_ends_an_episode() -> None:
    env = make_env(
        "lidarena/Exploration-v0", {"map": "maze:5?width=5&height=5", "stop_at": None, "max_episode_steps": 5000}
    )
    whole = run_episode(env, baselines.make("frontier", env), 2)
    assert whole.ending in ("policy finished: explored", "policy finished: fruitless"), "explorers tell why"
    assert whole.measures["completeness"] > 0.99 and whole.measures["success"] == 1.0
    part = run_episode(env, baselines.make("frontier", env), 2, max_steps=30)
    assert part.measures["completeness"] < 0.99 and part.measures["success"] == 0.0


def test_earlier_keywords_work_with_a_warning() -> None:
    env = make_env(CORRIDOR, {})
    with pytest.warns(DeprecationWarning, match="keyword 'keep_trace' of run_episode is now 'keep_picture'"):
        episode = run_episode(env, Driver(env), seed=0, keep_trace=True)  # type: ignore[call-arg]
    assert isinstance(episode.picture, RobotTrace)
