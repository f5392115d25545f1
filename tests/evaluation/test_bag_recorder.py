"""Rosbags of episodes: read back, they hold what the environment told, in ROS 2's terms."""

import math
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

from lidarena import baselines
from lidarena.base.errors import WriteError
from lidarena.evaluation.bag_recorder import BEGIN, BagRecorder
from lidarena.evaluation.episodes import run_episode
from lidarena.evaluation.recording import Recording
from lidarena.slam.logs.reading import read_recording

STORE = get_typestore(Stores.ROS2_HUMBLE)


def messages(bag: Path) -> dict[str, list[Any]]:
    """Every topic's messages in order."""
    found: dict[str, list[Any]] = {}
    with Reader(bag) as reader:
        for connection, stamp, raw in reader.messages():
            message = STORE.deserialize_cdr(raw, connection.msgtype)
            found.setdefault(connection.topic, []).append((stamp / 1e9, message))
    return found


def turn_of(rotation: Any) -> float:
    return 2 * math.atan2(rotation.z, rotation.w)


@pytest.fixture(scope="module")
def exploration(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[dict[str, Any]]]:
    """An episode of 30 steps, and its infos."""
    env = gym.make("lidarena/Env2-v0", expose_truth=True)
    policy = baselines.make("nearest_frontier", env)
    bag, infos = tmp_path_factory.mktemp("bags") / "drive", []
    with BagRecorder(bag) as recorder:

        def watch(recording: Recording) -> None:
            recorder.note(recording)
            infos.append(dict(recording.info))

        run_episode(env, policy, seed=1, max_steps=30, watch=watch)
    return bag, infos


def test_every_step_is_there_at_its_time(exploration: tuple[Path, list[dict[str, Any]]]) -> None:
    bag, infos = exploration
    found = messages(bag)
    assert set(found) == {"/clock", "/scan", "/odom", "/map", "/ground_truth", "/tf"}
    assert [time for time, _ in found["/odom"]] == pytest.approx([BEGIN + info["time"] for info in infos])
    assert len(found["/scan"]) == len(found["/tf"]) == len(infos) == 31


def test_scans_and_maps_are_what_the_robot_had(exploration: tuple[Path, list[dict[str, Any]]]) -> None:
    bag, infos = exploration
    found = messages(bag)
    for (_, scan), info in zip(found["/scan"], infos, strict=True):
        met = info["scan"] < scan.range_max
        assert np.array_equal(scan.ranges[met], info["scan"][met]) and np.isinf(scan.ranges[~met]).all()
        assert len(scan.ranges) == round((scan.angle_max - scan.angle_min) / scan.angle_increment) + 1
    _, last = found["/map"][-1]
    assert np.array_equal(last.data.reshape(last.info.height, last.info.width), infos[-1]["map"])
    assert last.info.resolution == pytest.approx(0.05)
    assert [last.info.origin.position.x, last.info.origin.position.y] == pytest.approx(infos[-1]["origin"].tolist())


def test_the_frames_lead_from_the_map_to_the_pose(exploration: tuple[Path, list[dict[str, Any]]]) -> None:
    bag, infos = exploration
    for (_, message), info in zip(messages(bag)["/tf"], infos, strict=True):
        pose = np.zeros(3)
        for transform in message.transforms[:2]:  # map → odom → base_link
            at, turn = transform.transform.translation, turn_of(transform.transform.rotation)
            cos, sin = math.cos(pose[2]), math.sin(pose[2])
            pose = pose + np.array([cos * at.x - sin * at.y, sin * at.x + cos * at.y, turn])
        assert pose[:2] == pytest.approx(info["pose"][:2], abs=1e-9)
        assert math.cos(pose[2] - info["pose"][2]) == pytest.approx(1.0)


def test_our_own_reader_takes_it_as_a_log(exploration: tuple[Path, list[dict[str, Any]]]) -> None:
    bag, infos = exploration
    log = read_recording(bag)
    assert len(log.ranges) == len(infos) and len(log.angles) == 360


def test_a_team_has_topics_and_frames_a_robot(tmp_path: Path) -> None:
    env = gym.make("lidarena/CorridorCentral-v0", robots=2, expose_truth=True)
    with BagRecorder(tmp_path / "team") as recorder:
        run_episode(env, baselines.make("independent_astar", env), seed=0, max_steps=3, watch=recorder.note)
    found = messages(tmp_path / "team")
    assert {"/robot_0/odom", "/robot_1/odom", "/robot_0/scan", "/robot_1/scan"} <= set(found)
    assert found["/robot_1/odom"][0][1].child_frame_id == "robot_1/base_link"


def test_a_place_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(WriteError, match="cannot be written"), BagRecorder(tmp_path / "file" / "bag"):
        pass
