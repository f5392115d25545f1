from pathlib import Path

import numpy as np
import pytest

from lidarena.slam.graph.mapper import Loop, PoseGraph
from lidarena.slam.logs.map_files import MAP_FILES, draw_loops, map_results, save_log_map
from lidarena.slam.logs.mapping import LogMap
from lidarena.slam.logs.recorded_log import LogError
from lidarena.slam.logs.trajectory import Trajectory
from lidarena.world.map_server import OccupancyMap
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

LOG = record(ring(), way(LAP, stride=0.5))
POSES = way(LAP, stride=0.5)
NODES = POSES[LOG.scan_readings[:3]]
RESULT = LogMap(
    trajectory=Trajectory(LOG.times, POSES),
    readings=LOG.scan_readings[:3],
    poses=NODES,
    map=OccupancyMap(np.pad(np.full((9, 9), 0, np.int8), 1, constant_values=100), 0.05, (0.0, 0.0, 0.0)),
    loops=[Loop(2, 0, np.zeros(3), 0.01, True), Loop(1, 0, np.zeros(3), 3.0, False)],
    graph=PoseGraph(NODES, np.arange(3), np.array([[0, 1], [1, 2]]), np.zeros((2, 3)), np.stack([np.eye(3)] * 2)),
    doubts=["the map is likely torn"],
    seconds=2.0,
)


def test_all_files_appear_at_once_and_earlier_ones_are_kept(tmp_path: Path) -> None:
    assert save_log_map(tmp_path / "out", LOG, RESULT) is None
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == sorted(MAP_FILES)
    assert save_log_map(tmp_path / "out", LOG, RESULT) == tmp_path / "out.1"
    (tmp_path / "out" / "mine").write_text("")
    with pytest.raises(LogError, match="holds 'mine'"):
        save_log_map(tmp_path / "out", LOG, RESULT)


def test_results_count_loops_and_carry_warnings() -> None:
    results = map_results(LOG, RESULT)
    assert (results["loops_closed"], results["loops_rejected"], results["largest_loop_residual_m"]) == (1, 1, 0.01)
    assert results["warnings"] == ["the map is likely torn"] and results["translation_m"] is None


def test_loops_are_drawn() -> None:
    axes = draw_loops(LOG, RESULT).axes[0]
    assert any(line.get_color() == "#009E73" for line in axes.lines) and "1 loops closed" in axes.get_title()
