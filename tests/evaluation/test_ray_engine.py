"""Episodes and trainings on a cluster of a head and two nodes: the same bits as here, also when a node is killed."""

import json
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from lidarena.agents import train, train_seeds
from lidarena.base.errors import ConfigError
from lidarena.base.ray_cluster import ClusterError, ray_results
from lidarena.cli import main
from lidarena.evaluation import compare
from tests.agents.training_cases import small

ray = pytest.importorskip("ray", reason="needs lidarena[ray]")
pytestmark = pytest.mark.filterwarnings("ignore")  # Ray leaves sockets and processes to the garbage collector

HERE = "tests.evaluation.fake_world"


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    from ray.cluster_utils import Cluster

    patch = pytest.MonkeyPatch()
    patch.setenv("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
    patch.setenv("RAY_worker_niceness", "0")  # beside the other tests they would hardly run
    made = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    nodes = [made.add_node(num_cpus=1) for _ in range(2)]
    made.nodes_of_the_test = nodes
    yield made
    ray.shutdown()
    made.shutdown()
    patch.undo()


def comparison(out: Path, **keys: Any) -> dict[str, Any]:
    envs = [f"{HERE}:fake/Corridor-v0"]
    return {
        "envs": envs,
        "policies": [f"{HERE}:Driver"],
        "episodes": 3,
        "out": str(out),
        "pictures": False,
        "report": False,
        **keys,
    }


def results(folder: Path) -> str:
    """All that was found, but for the clock's."""
    content = json.loads((folder / "results.json").read_text())
    for row in content["rows"]:
        del row["metrics"]["decision_time"]
    del content["config"]["out"], content["config"]["workers"]
    return json.dumps(content)


def slow_square(number: int) -> int:
    time.sleep(1.0)
    return number**2


def die(number: int) -> int:
    if number == 2:
        os._exit(1)
    return number


def test_a_comparison_is_to_the_bit_the_one_of_this_machine(cluster: Any, tmp_path: Path) -> None:
    compare(comparison(tmp_path / "here", videos="gif", workers=1))
    compare(comparison(tmp_path / "there", videos="gif", engine="ray", ray_address=cluster.address))
    assert results(tmp_path / "here") == results(tmp_path / "there")
    here, there = (next((tmp_path / which).rglob("*.gif")).read_bytes() for which in ("here", "there"))
    assert here == there


def test_trainings_are_to_the_bit_those_of_this_machine(cluster: Any, tmp_path: Path) -> None:
    config = small(tmp_path / "runs", "total_steps=64")
    told: list[str] = []
    folders = train_seeds(config, [3, 4], "ray", cluster.address, told.append)
    alone = train(config.model_copy(update={"seed": 4, "out": str(tmp_path / "alone")}), progress=False)
    assert [folder.name for folder in folders] == ["seed3", "seed4"] and len(told) == 2
    weights = [(folder / "policy.safetensors").read_bytes() for folder in (folders[1], alone)]
    assert weights[0] == weights[1]


def test_an_item_whose_worker_dies_twice_is_named(cluster: Any) -> None:
    with pytest.raises(ClusterError) as caught:
        dict(ray_results(die, [0, 1, 2], cluster.address))
    assert caught.value.index == 2


def test_a_node_that_is_killed_costs_a_second_try_and_nothing_else(cluster: Any) -> None:
    found = {}
    for index, square in ray_results(slow_square, range(6), cluster.address):
        found[index] = square
        if len(found) == 1:
            cluster.remove_node(cluster.nodes_of_the_test.pop(), allow_graceful=False)
    assert found == {number: number**2 for number in range(6)}


def test_a_cluster_that_is_not_there(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"no Ray cluster answers at '127\.0\.0\.1:9': "):
        compare(comparison(tmp_path / "x", engine="ray", ray_address="127.0.0.1:9"))
    with pytest.raises(ConfigError, match="must be auto, HOST:PORT"):
        list(ray_results(slow_square, [1], "nowhere"))
    train_here = ["train", "quick", "--seeds", "0,1", "--engine", "ray", "--ray-address", "127.0.0.1:9"]
    assert main([*train_here, "--out", str(tmp_path / "runs")]) == 2
    assert "no Ray cluster answers" in capsys.readouterr().err
    assert not list((tmp_path / "runs").iterdir())
