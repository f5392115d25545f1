"""``lidarena map`` writes everything at once, from a log and from a bag, and refuses bad input in one sentence."""

import json
from pathlib import Path

import numpy as np
import pytest

from lidarena.cli import main
from lidarena.slam.logs.carmen import save_log
from lidarena.slam.logs.map_files import MAP_FILES
from lidarena.slam.logs.trajectory import load_tum
from lidarena.world.map_server import load_map
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, relations_of, way
from tests.slam.logs.test_rosbag import bag_of
from tests.slam.test_main import save_relations

TRUTH = way(LAP)
LOG = record(ring(), TRUTH)


def test_a_log_is_mapped_and_everything_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = save_log(tmp_path / "a.log.gz", LOG)
    relations = save_relations(tmp_path / "a.relations", relations_of(LOG, TRUTH))
    assert main(["map", str(log), "--relations", str(relations), "--out", str(tmp_path / "out")]) == 0
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == sorted(MAP_FILES)
    results = json.loads((tmp_path / "out" / "results.json").read_text())
    assert results["translation_m"] < 0.1 and results["scans"] == len(LOG.ranges)
    assert load_map(tmp_path / "out" / "map.yaml").resolution == 0.05
    assert len(load_tum(tmp_path / "out" / "trajectory.tum").times) == len(LOG.times)
    assert (tmp_path / "out" / "posegraph.g2o").read_text().startswith("VERTEX_SE2 0 ")
    assert "relations:  60 relations: translation 0.0" in capsys.readouterr().out


def test_a_bag_is_mapped_and_its_topics_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["map", str(bag_of(tmp_path / "a.bag", "bag", LOG)), "--out", str(tmp_path / "out")]) == 0
    assert "scans are read from /scan, odometry from /odom" in capsys.readouterr().out


@pytest.mark.parametrize("more", [["--max-range", "-1"], ["--fov", "400"], ["--out", "."], ["--relations", "none"]])
def test_bad_input_ends_with_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], more: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    log = save_log(tmp_path / "a.log", LOG)
    assert main(["map", str(log), *more]) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1


def test_a_missing_log_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["map", str(tmp_path / "none.log"), "--out", str(tmp_path / "out")]) == 2
    assert "cannot be read: No such file" in capsys.readouterr().err
    assert np.array_equal(list(tmp_path.iterdir()), [])
