"""Replays: what is kept of an episode, that it stays small, and that it comes back from its file."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena import baselines
from lidarena.base.errors import ConfigError
from lidarena.evaluation.episodes import run_episode
from lidarena.evaluation.participants import make_env
from lidarena.evaluation.recording import Recording
from lidarena.evaluation.replay import MOST_BEAMS, MOST_FRAMES, MOST_POINTS, EpisodeReplay, ReplayRecorder, _planned
from tests.evaluation.fake_world import Driver

CORRIDOR = "tests.evaluation.fake_world:fake/Corridor-v0"


def maps_of(content: dict[str, Any]) -> list[np.ndarray]:
    """The map of every frame, put together from its changes as the player does."""
    size = content["map"]
    now, shown = np.zeros(size["rows"] * size["columns"], int), []
    for changes in content["map"]["changes"]:
        coded = np.cumsum(np.array(changes, int))
        now[coded // 3] = coded % 3
        shown.append(now.reshape(size["rows"], size["columns"]).copy())
    return shown


def test_an_episode_of_the_fake_world_is_kept_whole() -> None:
    env = make_env(CORRIDOR, {"slip": 0.0})
    episode = run_episode(env, Driver(env, back=0.0), seed=3, keep_replay=True)
    assert episode.replay is not None
    content = dict(episode.replay.content)
    assert content["times"] == [round(0.2 * k, 3) for k in range(36)]
    true = np.array(content["true"])
    assert true.shape == (36, 1, 3) and (np.diff(true[:, 0, 0]) == 100).all()  # mm
    assert content["believed"][0] == content["true"][0] and len(content["walls"]) == 8
    first, last = maps_of(content)[0], maps_of(content)[-1]
    assert first.shape == (20, 80) and (first[1:19, :6] == 1).all() and (first[[0, 19], :6] == 2).all()
    assert (last[1:19, :76] == 1).all() and (last[:, 76:] == 0).all()


def test_nothing_is_kept_unless_it_is_asked_for() -> None:
    env = make_env(CORRIDOR, {})
    assert run_episode(env, Driver(env), seed=0).replay is None


def test_an_exploration_shows_particles_scans_and_the_planned_path() -> None:
    env = gym.make("lidarena/Env2-v0", expose_truth=True)
    policy = baselines.make("nearest_frontier", env)
    replay = run_episode(env, policy, seed=1, max_steps=40, keep_replay=True).replay
    assert replay is not None
    content = replay.content
    assert np.array(content["particles"]).shape == (41, 30, 2)
    beams = len(content["angles"])
    assert beams <= MOST_BEAMS and np.array(content["scans"]).shape == (41, 1, beams)
    assert any(len(path) > 1 for path in content["planned"])
    assert content["radius"] == 105
    hit = np.array(content["scans"][0][0]) / 100
    x, y, turn = np.array(content["true"][0][0]) / 1000
    ends = np.column_stack([x + hit * np.cos(turn + content["angles"]), y + hit * np.sin(turn + content["angles"])])
    low_x, low_y, high_x, high_y = env.unwrapped.floorplan.bounds  # type: ignore[attr-defined]
    assert ((ends > [low_x - 0.2, low_y - 0.2]) & (ends < [high_x + 0.2, high_y + 0.2])).all()


def test_a_team_is_kept_with_everybodys_goal() -> None:
    env = gym.make("lidarena/CorridorCentral-v0", robots=3, expose_truth=True)
    policy = baselines.make("prioritized_search", env)
    replay = run_episode(env, policy, seed=0, max_steps=10, keep_replay=True).replay
    assert replay is not None
    assert np.array(replay.content["true"]).shape == (11, 3, 3)
    assert np.array(replay.content["goals"]).shape == (11, 3, 2)
    assert np.array(replay.content["scans"]).shape[1] == 3


class Walker:
    """Just enough of a recording: somebody who walks along x and maps as he goes."""

    def __init__(self, grown: bool = False) -> None:
        self.env: Any = gym.make("CartPole-v1")
        self.policy, self.step, self.grown = object(), -1, grown
        self.info: dict[str, Any] = {}

    def walk(self) -> "Walker":
        self.step += 1
        cells = np.full((4, 4 + (self.step if self.grown else 0)), -1, np.int8)
        cells[1, : self.step % 4] = 0
        place = {"origin": np.zeros(2), "resolution": 0.5}
        self.info = {"pose": np.array([self.step, 0.0, 0.0]), "time": float(self.step), "map": cells, **place}
        return self


def test_a_long_episode_is_thinned_out_and_keeps_its_end() -> None:
    walker, recorder = Walker(), ReplayRecorder()
    for _ in range(2 * MOST_FRAMES + 4):
        recorder.note(walker.walk())  # type: ignore[arg-type]
    replay = recorder.finish(walker)  # type: ignore[arg-type]
    assert replay is not None
    times = replay.content["times"]
    assert MOST_FRAMES / 2 <= len(times) <= MOST_FRAMES + 1
    assert times[0] == 0 and times[-1] == 2 * MOST_FRAMES + 3 and (np.diff(times) > 0).all()


def test_a_map_that_grows_is_shown_in_its_last_size() -> None:
    walker, recorder = Walker(grown=True), ReplayRecorder()
    for _ in range(4):
        recorder.note(walker.walk())  # type: ignore[arg-type]
    replay = recorder.finish(walker)  # type: ignore[arg-type]
    assert replay is not None
    shown = maps_of(dict(replay.content))
    assert shown[0].shape == (4, 7)
    assert [int((frame == 1).sum()) for frame in shown] == [0, 1, 2, 3]


def test_an_environment_without_poses_has_none() -> None:
    env = gym.make("CartPole-v1")
    recorder, recording = ReplayRecorder(), Recording(env, object())  # type: ignore[arg-type]
    recording.note({"time": 1.0, "pose": np.array([np.nan, 0, 0]), "goal": {"a": 1}})
    recorder.note(recording)
    assert recorder.finish(recording) is None


def test_a_replay_comes_back_from_its_file(tmp_path: Path) -> None:
    replay = EpisodeReplay({"times": [0.0, 0.2], "true": [[[0, 0, 0]], [[1, 2, 3]]]})
    file = tmp_path / "deep" / "a.json.gz"
    replay.write(file)
    assert EpisodeReplay.read(file) == replay
    file.write_bytes(file.read_bytes()[:-9])
    with pytest.raises(ConfigError, match="is no replay, or is torn"):
        EpisodeReplay.read(file)
    with pytest.raises(ConfigError, match="is no replay"):
        EpisodeReplay.read(tmp_path / "nowhere.json.gz")


@pytest.mark.parametrize("points", [0, 1, 200, 201, 100_000])
def test_of_a_long_planned_path_some_points_are_kept_and_its_ends(points: int) -> None:
    path = np.stack([np.arange(points), np.zeros(points)], axis=1)
    kept = _planned(SimpleNamespace(path=path))
    assert kept is not None and len(kept) <= min(points, MOST_POINTS + 1)
    if points:
        np.testing.assert_array_equal(kept[[0, -1]], path[[0, -1]])
    if points <= MOST_POINTS:
        np.testing.assert_array_equal(kept, path)
