"""Which edges and circles the lidar looks at, by tile."""

import numpy as np
import pytest

from lidarena.world.map_geometry import TILE, MapGeometry, lay_out
from lidarena.world.random_plans import random_plan

REACH = 2.0


def items_of(geometry: MapGeometry, plan: int, x: float, y: float) -> set[int]:
    column, row = np.floor((np.array([x, y]) - geometry.tile_origin[plan]) / TILE).astype(int)
    tile = geometry.first_tile[plan] + row * geometry.tile_shape[plan, 1] + column
    return set(geometry.items[geometry.tile_start[tile] : geometry.tile_start[tile + 1]].tolist())


def segment_distance(edge: np.ndarray, point: np.ndarray) -> float:
    along = edge[2:] - edge[:2]
    share = np.clip((point - edge[:2]) @ along / (along @ along), 0.0, 1.0)
    return float(np.hypot(*(point - edge[:2] - share * along)))


@pytest.mark.parametrize("kind", ["furnished", "cave"])
def test_nothing_within_range_is_missing_where_a_robot_may_stand(kind: str) -> None:
    plan = random_plan(kind, np.random.default_rng(3), area=60)
    geometry, rng = lay_out([plan], REACH), np.random.default_rng(0)
    for point in rng.uniform(plan.bounds[:2], plan.bounds[2:], (60, 2)):
        found = items_of(geometry, 0, *point)
        for k, (x1, y1, x2, y2) in enumerate(plan.edges):
            in_front = (x2 - x1) * (point[1] - y1) - (y2 - y1) * (point[0] - x1) < 0.0
            if in_front and segment_distance(plan.edges[k], point) <= REACH:
                assert k in found
        for k, (x, y, radius) in enumerate(plan.circles):
            if np.hypot(point[0] - x, point[1] - y) <= REACH + radius:
                assert len(plan.edges) + k in found


def test_what_is_far_away_is_left_out() -> None:
    plan = random_plan("furnished", np.random.default_rng(3), width=15, height=10)
    geometry = lay_out([plan], REACH)
    per_tile = np.diff(geometry.tile_start)
    assert per_tile.max() < 0.5 * (len(plan.edges) + len(plan.circles))


def test_plans_stand_behind_one_another() -> None:
    plans = [random_plan(kind, np.random.default_rng(1), area=40) for kind in ("warehouse", "furnished")]
    both = lay_out(plans, REACH)
    for index, plan in enumerate(plans):
        alone = lay_out([plan], REACH)
        own, shared = items_of(alone, 0, *plan.start[:2]), items_of(both, index, *plan.start[:2])
        before = plans[0] if index else None
        edges = {k for k in own if k < len(plan.edges)}
        shift = 0 if before is None else len(before.edges)
        assert {k for k in shared if k < len(both.edges)} == {k + shift for k in edges}
        assert len(shared) == len(own)
