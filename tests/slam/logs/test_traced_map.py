"""Maps traced part by part equal those traced in one piece; the evidence prefers the true way."""

from dataclasses import replace

import numpy as np
import pytest

from lidarena.base.errors import MapError
from lidarena.slam.logs.traced_map import trace_map, traced
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

TRUTH = way(LAP)
LOG = record(ring(), TRUTH)
SCANS = np.arange(len(LOG.ranges))
POSES = TRUTH[LOG.scan_readings]


@pytest.mark.parametrize("part", [40, 97, 333])
@pytest.mark.parametrize("resolution", [0.05, 0.11])
def test_parts_make_the_same_map_as_one_piece(part: int, resolution: float) -> None:
    whole = traced(LOG, SCANS, POSES, resolution=resolution, part=100_000)
    parts = traced(LOG, SCANS, POSES, resolution=resolution, part=part)
    differs = parts.grid.occupancy != whole.grid.occupancy
    assert differs.mean() < 1e-3, "beams that end on the border of two cells may be rounded to the other"
    assert parts.grid.origin == whole.grid.origin
    assert parts.evidence == pytest.approx(whole.evidence, rel=2e-3)


def test_a_way_of_a_kilometre_is_mapped_in_little_memory() -> None:
    import tracemalloc

    ends = np.array([[0.0, 0.0, 0.0], [700.0, 500.0, 0.0]])
    tracemalloc.start()
    grid = trace_map(LOG, SCANS[:2], ends, resolution=0.05)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert grid.occupancy.size > 100_000_000
    assert peak < 3.5 * grid.occupancy.size, "bytes a cell: the map itself, its cut and one part"
    near = trace_map(LOG, SCANS[:1], ends[:1])
    corner = grid.occupancy[: near.occupancy.shape[0], : near.occupancy.shape[1]]
    np.testing.assert_array_equal(corner, near.occupancy)


def test_too_large_a_map_is_refused_with_a_way_out() -> None:
    with pytest.raises(MapError, match="million cells are allowed, so they must be larger ones"):
        trace_map(LOG, SCANS[:2], np.array([[0.0, 0.0, 0.0], [900.0, 900.0, 0.0]]), resolution=0.02)


@pytest.mark.parametrize("wrong", ["bent", "torn", "folded"])
def test_the_evidence_is_largest_on_the_true_way(wrong: str) -> None:
    poses = POSES.copy()
    late = slice(len(poses) // 2, None)
    if wrong == "bent":
        poses[:, 2] += np.linspace(0.0, 0.15, len(poses))
    if wrong == "torn":
        poses[late, 0] += 0.4
    if wrong == "folded":
        poses[late, 1] -= 2.0
    assert traced(LOG, SCANS, poses).evidence < traced(LOG, SCANS, POSES).evidence - 100.0


def test_a_log_without_returns_has_an_unknown_map() -> None:
    silent = replace(LOG, ranges=np.full_like(LOG.ranges, LOG.max_range))
    found = traced(silent, SCANS, POSES)
    assert found.grid.occupancy.tolist() == [[-1]] and found.evidence == 0.0
