from pathlib import Path

import numpy as np

from lidarena.slam.graph.mapper import PoseGraph
from lidarena.slam.logs.posegraph_file import save_g2o


def test_a_graph_is_written_with_its_vertices_edges_and_upper_triangles(tmp_path: Path) -> None:
    information = np.arange(9.0).reshape(1, 3, 3)
    nodes = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.5]])
    graph = PoseGraph(nodes, np.arange(2), np.array([[0, 1]]), nodes[1:], information)
    lines = save_g2o(tmp_path / "a.g2o", graph).read_text().splitlines()
    assert lines[1].split() == ["VERTEX_SE2", "1", "1.000000", "2.000000", "0.500000000"]
    assert lines[2] == "EDGE_SE2 0 1 1 2 0.5 0 1 2 4 5 8"
