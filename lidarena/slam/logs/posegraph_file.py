"""Pose graphs in g2o's text format, which g2o, GTSAM and SE-Sync read."""

from pathlib import Path

import numpy as np

from lidarena.base.files import write_text
from lidarena.slam.graph.mapper import PoseGraph


def save_g2o(path: str | Path, graph: PoseGraph) -> Path:
    """Write ``VERTEX_SE2`` and ``EDGE_SE2`` lines; a vertex has the number of its node, its information is a row."""
    lines = [f"VERTEX_SE2 {k} {x:.6f} {y:.6f} {theta:.9f}" for k, (x, y, theta) in enumerate(graph.nodes)]
    upper = np.triu_indices(3)
    for (first, second), motion, information in zip(graph.pairs, graph.motions, graph.information, strict=True):
        numbers = " ".join(f"{value:.9g}" for value in [*motion, *information[upper]])
        lines.append(f"EDGE_SE2 {first} {second} {numbers}")
    return write_text(path, "\n".join(lines) + "\n")
