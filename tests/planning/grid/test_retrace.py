import math

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.planning.grid.path_following import predict
from lidarena.planning.grid.retrace import SPACING, VIEWS, is_cut_off, note_view, sharp_map, way_back
from lidarena.planning.grid.steering import Commands

DISCRETE = Commands.of([(0.5, 0.0), (0.05, 0.3), (0.05, -0.3)], 0.2)
ANGLES = np.arange(360) * math.radians(1.0)
KEEP, TOUCH, SIGHT = 0.135, 0.12, 3.5
# a hall, and beside it a pocket of 0.8 x 0.9 m behind a mouth of 0.5 m
WALLS = np.array(
    [
        *((0, 0, 3, 0), (3, 0, 3, 1), (3, 1.5, 3, 2.5), (3, 2.5, 0, 2.5), (0, 2.5, 0, 0)),
        *((3, 1, 3.8, 1), (3.8, 1, 3.8, 1.9), (3.8, 1.9, 3, 1.9)),
    ],
    float,
)


def scan_of(pose: NDArray[np.float64]) -> NDArray[np.float32]:
    """What the lidar measures without noise."""
    directions = ANGLES + pose[2]
    away = np.stack([np.cos(directions), np.sin(directions)], axis=1)[:, None]
    first, along = WALLS[None, :, :2] - pose[:2], (WALLS[:, 2:] - WALLS[:, :2])[None]
    with np.errstate(divide="ignore", invalid="ignore"):
        across = away[..., 0] * along[..., 1] - away[..., 1] * along[..., 0]
        far = (first[..., 0] * along[..., 1] - first[..., 1] * along[..., 0]) / across
        share = (first[..., 0] * away[..., 1] - first[..., 1] * away[..., 0]) / across
    hit = (far > 0.0) & (share >= 0.0) & (share <= 1.0)
    return np.minimum(np.where(hit, far, SIGHT).min(axis=1), SIGHT).astype(np.float32)


def room_at(place: NDArray[np.float64]) -> float:
    """Distance to the nearest wall."""
    along = WALLS[:, 2:] - WALLS[:, :2]
    share = np.clip(((place[:2] - WALLS[:, :2]) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    return float(np.hypot(*(WALLS[:, :2] + share[:, None] * along - place[:2]).T).min())


def driven_in(turns: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float32]]:
    """The pose of a robot that has driven into the pocket and turned there, and its views."""
    commands = [0] * 15 + [1] * turns
    poses = np.vstack([[1.9, 1.25, 0.0], predict(np.array([1.9, 1.25, 0.0]), DISCRETE, np.array(commands))])
    assert min(room_at(pose) for pose in poses) > KEEP
    places, ranges = np.zeros((VIEWS, 3)), np.zeros((VIEWS, len(ANGLES)), np.float32)
    made_at, count = np.zeros(VIEWS, np.int64), 0
    for step, pose in enumerate(poses):
        count = note_view(places, ranges, made_at, count, pose, scan_of(pose), step, True)
    return poses[-1], places[:count], ranges[:count]


@pytest.mark.parametrize("turns", [0, 20, 40, 60, 90])
def test_who_has_driven_into_a_pocket_drives_out_again(turns: int) -> None:
    here, places, ranges = driven_in(turns)
    scan = scan_of(here)
    points = np.stack([scan * np.cos(ANGLES), scan * np.sin(ANGLES)], axis=1)[scan < 2.5].astype(np.float64)
    left = places[:, 0] < 2.8
    found = way_back(places, ranges, left, ANGLES, SIGHT, here, points, DISCRETE, KEEP)
    assert len(found)
    way = predict(here, DISCRETE, found)
    assert min(room_at(pose) for pose in way) > KEEP - 0.005
    assert way[-1, 0] < 2.85
    nowhere = way_back(places, ranges, np.zeros(len(left), bool), ANGLES, SIGHT, here, points, DISCRETE, KEEP)
    assert len(nowhere) == 0


def test_what_no_view_has_shown_is_a_wall() -> None:
    here, places, ranges = driven_in(0)
    side = sharp_map(places, ranges, ANGLES, SIGHT, here)
    middle = side.shape[0] // 2
    assert side[middle, middle] == pytest.approx(room_at(here), abs=0.06)
    lone = sharp_map(places[-1:], ranges[-1:], ANGLES, SIGHT, here)
    assert (lone <= side + 1e-6).all() and (lone < side).any()
    behind = middle + round((2.2 - here[1]) / 0.03), middle + round((2.6 - here[0]) / 0.03)
    assert side[behind] > 0.1  # it was seen from the hall, but is not from the pocket
    assert lone[behind] == 0.0


def test_of_every_place_the_newest_view_is_kept_and_the_oldest_makes_room() -> None:
    places, ranges = np.zeros((3, 3)), np.zeros((3, 4), np.float32)
    made_at, count = np.zeros(3, np.int64), 0
    for step, x in enumerate((0.05, 0.1, 1.05, 2.05, 3.05)):
        scan = np.full(4, step, np.float32)
        count = note_view(places, ranges, made_at, count, np.array([x, 0.0, 0.0]), scan, step, True)
    assert count == 3 and sorted(made_at) == [2, 3, 4]
    assert ranges[:, 0].tolist() == made_at.tolist() and abs(places[0, 0] - 3.05) < SPACING
    for turned in (0.5, 1.5):
        note_view(places, ranges, made_at, count, np.array([3.05, 0.0, turned]), scan, 9, False)
    assert (made_at == 9).sum() == 2  # where it does not see all around, directions are told apart


def test_a_robot_is_cut_off_whose_map_shows_no_way_to_where_it_came_from() -> None:
    places = np.array([(0.0, 0.0, 0.0), (1.5, 0.0, 0.0), (2.0, 0.0, 0.0)])
    here, pose, frame = np.array([2.0, 0.0, 0.0]), np.array([5.0, 5.0, math.pi / 2]), np.array([0.0, 0.0, 0.1])
    reachable = np.zeros((100, 100), bool)
    reachable[45:52, 45:52] = True
    assert is_cut_off(places, here, pose, reachable, frame, 1.0)  # 0, 0 lies at 5, 3 on the map
    assert not is_cut_off(places[1:], here, pose, reachable, frame, 1.0)  # nothing is far enough to count
    reachable[30, 50] = True
    assert not is_cut_off(places, here, pose, reachable, frame, 1.0)
