import numpy as np
import pytest

from lidarena.slam.occupancy import empty_maps, trace_scan
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
from lidarena.slam.scan_outline import empty_outlines
from lidarena.world.floorplan import Floorplan
from tests.slam.drive import FORWARD, LEFT, Drive, corridor, ring, turn

QUICK = FilterParameters(particles=30)


def test_the_covariance_grows_along_a_bare_corridor() -> None:
    ratios = []
    for seed in range(3):
        _, covariances = Drive(corridor(40.0), seed=seed).run([FORWARD] * 240)
        along = covariances[:, 0, 0]
        # given its heading (a small turn at the start is 24 m away), the walls tell where across the robot is
        across = covariances[:, 1, 1] - covariances[:, 1, 2] ** 2 / covariances[:, 2, 2]
        assert along[200:].mean() > 2.5 * along[20:60].mean()
        ratios.append(along[200:].mean() / across[200:].mean())
    assert np.mean(ratios) > 2


def test_the_covariance_falls_when_a_loop_closes() -> None:
    drive = Drive(ring(), seed=2)
    sides = []
    for _ in range(4):
        _, covariance = drive.run([FORWARD] * 60)
        sides.append(covariance)
        drive.run(turn(np.pi / 2))
    before = np.linalg.det(sides[3][-30:]).max()
    _, closed = drive.run([FORWARD] * 20)
    assert np.linalg.det(closed[-6:]).min() < before


def test_the_filter_keeps_track_where_the_odometry_does_not() -> None:
    errors, odometry = [], []
    for seed in range(3):
        drive = Drive(ring(), seed=seed)
        pose = np.array(drive.physics.poses[0, 0])
        commands = ([FORWARD] * 56 + turn(np.pi / 2)) * 4
        for command in commands:
            error, _ = drive.run([command])
            errors.append(error[0])
            dx, dy, dt = drive.readings[0, 0]
            pose += (dx * np.cos(pose[2]) - dy * np.sin(pose[2]), dx * np.sin(pose[2]) + dy * np.cos(pose[2]), dt)
            odometry.append(np.hypot(*(pose - drive.physics.poses[0, 0])[:2]))
    assert np.mean(errors) < 0.1
    assert np.mean(errors) < 0.2 * np.mean(odometry)


def test_same_seed_same_bits_and_another_seed_another_cloud() -> None:
    commands = [FORWARD] * 12 + [LEFT] * 12
    runs = []
    for seed in (4, 4, 5):
        drive = Drive(ring(), seed=seed)
        drive.run(commands)
        runs.append(drive.filters.state.particles.tobytes())
    assert runs[0] == runs[1] != runs[2]


def test_scans_are_processed_by_turtlebot3s_rule() -> None:
    drive = Drive(ring())
    for steps, expected in [(1, 1), (1, 1), (1, 2), (3, 3)]:  # more than 0.5 s: every third step of 0.2 s
        drive.run([FORWARD] * steps)
        assert drive.filters.state.updates[0] == expected


def test_the_published_map_is_what_tracing_the_best_past_alone_gives() -> None:
    drive = Drive(ring(), seed=1)
    drive.run([FORWARD] * 50 + turn(np.pi / 2) + [FORWARD] * 30)
    state, maps = drive.filters.state, drive.filters.maps
    again = empty_maps(1, maps.wanted)
    again.origin[:] = maps.origin
    outlines = empty_outlines(1, maps.wanted.shape[1], 360, 3.5, 0.05)
    for node in range(int(state.updates[0])):
        pose = state.node_poses[0, node, state.published[0, node]]
        trace_scan(again, 0, 0.05, pose, state.node_scans[0, node], drive.lidar.directions, 3.5, 1, outlines, 0)
    assert np.array_equal(again.visits, maps.visits)
    assert np.array_equal(again.hits, maps.hits)
    assert np.array_equal(again.occupancy, maps.occupancy)
    assert again.covered[0] == maps.covered[0] == ((maps.occupancy[0] >= 0) & (maps.wanted[0] > 0)).sum()


def test_the_published_past_is_one_particles_ancestry() -> None:
    drive = Drive(ring(), seed=1)
    drive.run([FORWARD] * 50 + turn(np.pi / 2) + [FORWARD] * 30)
    state = drive.filters.state
    shown = state.published[0, : int(state.updates[0])]
    for node in range(len(shown) - 1, 0, -1):
        assert state.node_parents[0, node, shown[node]] == shown[node - 1]


def test_weights_are_normalised_and_n_eff_lies_between_one_and_n() -> None:
    drive = Drive(ring(), parameters=QUICK)
    drive.run([FORWARD] * 40)
    assert drive.filters.state.weights[0].sum() == pytest.approx(1.0)
    assert 1.0 <= drive.filters.state.criteria[0, 2] <= 30.0
    assert 0.0 <= drive.filters.state.criteria[0, 1] <= np.log(30) + 1e-9


def test_starting_again_forgets_everything() -> None:
    drive = Drive(ring(), seed=3)
    first = drive.filters.maps.visits.copy()
    scans, pose = drive.scans.copy(), drive.physics.poses[0, 0].copy()
    drive.run([FORWARD] * 40)
    drive.filters.start(0, 0, drive.raster.origin, pose)
    drive.filters.step(0, 0.2, drive.readings[0, 0], scans[0, 0], drive.streams[0])
    assert np.array_equal(drive.filters.maps.visits, first)
    fields = drive.filters.state.fields
    used = set(np.unique(fields.table[0])) - {0}
    assert fields.free_count[0] + len(used) == fields.free.shape[1] - 1


def test_a_robot_that_sees_nothing_only_follows_its_odometry() -> None:
    plan = Floorplan.from_shapes("plain", (0, 0, 60, 60), walls=[(0, 0, 60, 0)], start=(30, 30, 0))
    drive = Drive(plan, seed=0)
    _, covariances = drive.run([FORWARD] * 60)
    assert np.isfinite(covariances).all()
    assert np.linalg.det(covariances[-1]) > np.linalg.det(covariances[10])
