import numpy as np
import pytest

from lidarena.base.errors import MapError
from lidarena.envs.exploration.coverage import measure_coverage
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan
from lidarena.world.robots import RobotSpec

BOX = [(0, 0, 4, 0), (4, 0, 4, 3), (4, 3, 0, 3), (0, 3, 0, 0)]


def box(**keywords: object) -> Floorplan:
    return Floorplan.from_shapes("box", (0, 0, 4, 3), walls=BOX, start=(0.7, 0.7, 0.0), **keywords)  # type: ignore[arg-type]


def test_a_room_is_covered_by_its_floor_and_the_walls_faces() -> None:
    wanted = measure_coverage(box(), 0.05, RobotSpec()).wanted
    floor, faces = (3.9 / 0.05) * (2.9 / 0.05), 2 * (3.9 + 2.9) / 0.05
    assert wanted.sum() == pytest.approx(floor + faces, rel=0.02)


def test_a_room_without_a_door_is_not_wanted() -> None:
    closed = box(polygons=[[(2, 0), (2, 3), (2.1, 3), (2.1, 0)]])
    coverage = measure_coverage(closed, 0.05, RobotSpec())
    columns = np.flatnonzero(coverage.wanted.any(axis=0))
    assert coverage.origin[0] + columns.max() * 0.05 < 2.1
    assert (coverage.starts[:, 0] < 2.0).all()


def test_a_slit_too_narrow_for_the_robot_is_not_wanted() -> None:
    slit = box(polygons=[[(2, 0), (2, 1.4), (2.1, 1.4), (2.1, 0)], [(2, 1.6), (2, 3), (2.1, 3), (2.1, 1.6)]])
    assert (
        measure_coverage(slit, 0.05, RobotSpec()).wanted.sum()
        < 0.6 * measure_coverage(box(), 0.05, RobotSpec()).wanted.sum()
    )


@pytest.mark.parametrize("name", ["env1", "env2", "env3", "env4", "willow_lobby"])
def test_perfect_mapping_can_know_all_of_it(name: str) -> None:
    """Scans without noise from every reachable place find every wanted cell: 100% is attainable."""
    from lidarena.slam.occupancy import empty_maps, trace_scan
    from lidarena.slam.scan_outline import empty_outlines
    from lidarena.world.lidar import Lidar

    plan = load_floorplan(name)
    coverage = measure_coverage(plan, 0.05, RobotSpec())
    lidar, maps = Lidar([plan]), empty_maps(1, coverage.wanted[None].astype(np.uint8))
    maps.origin[0] = coverage.origin
    outlines = empty_outlines(1, len(coverage.wanted), 360, 3.5, 0.05)
    for x, y in coverage.starts[::23]:
        pose = np.array([x, y, 0.0])
        ranges = lidar.cast(pose[None, None], np.zeros(1, np.int64))[0, 0]
        scan = np.where(ranges < 3.5, ranges + 1e-3, 3.5).astype(np.float32)
        trace_scan(maps, 0, 0.05, pose, scan, lidar.directions, 3.5, 1, outlines, 0)
    assert maps.covered[0] / coverage.wanted.sum() > 0.99


def rooms_with_a_door(width: float) -> Floorplan:
    """Two rooms of 2 m x 2 m, the start in the left one."""
    edge, half = 2.05, width / 2.0 + 0.05  # walls have square ends
    outer = [(0, 0, 4.1, 0), (4.1, 0, 4.1, 2), (4.1, 2, 0, 2), (0, 2, 0, 0)]
    inner = [(edge, 0, edge, 1.0 - half), (edge, 1.0 + half, edge, 2)]
    return Floorplan.from_shapes("rooms", (0, 0, 4.1, 2), walls=[*outer, *inner], thickness=0.1, start=(1.0, 1.0, 0.0))


@pytest.mark.parametrize(("door", "clearance", "both"), [(0.5, None, True), (0.5, 0.22, True), (0.4, 0.22, False)])
def test_a_room_behind_a_door_too_narrow_for_the_clearance_does_not_count(
    door: float, clearance: float | None, both: bool
) -> None:
    plan = rooms_with_a_door(door)
    wanted = measure_coverage(plan, 0.05, RobotSpec(clearance=clearance)).wanted
    assert bool(wanted[:, wanted.shape[1] // 2 + 8 :].sum() > 500) == both
    roomy = measure_coverage(plan, 0.05, RobotSpec()).wanted
    left = slice(0, wanted.shape[1] // 2 - 4)
    assert (wanted[:, left] == roomy[:, left]).mean() > 0.995, "corners of the first room count as before"


def test_a_start_without_the_clearance_is_refused() -> None:
    with pytest.raises(MapError, match=r"keeps a clearance of 1\.5 m does not fit at the start"):
        measure_coverage(rooms_with_a_door(0.6), 0.05, RobotSpec(clearance=1.5))
