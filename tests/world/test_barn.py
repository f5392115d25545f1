import json

import numpy as np
import pytest

from lidarena.base.errors import MapError
from lidarena.world.arenas import load_arena
from lidarena.world.barn import GOAL, START, barn_indices, load_barn
from tests.world.shared_data import DATA

BARN = DATA / "barn" / "barn_even_150.npz"
needs_barn = pytest.mark.skipif(not BARN.is_file(), reason=f"the BARN worlds are not at {BARN}")
SMALL = {
    "world": np.array([0, 2]),
    "xyr": np.array([(-1, 6, 0.075), (-2, 7, 0.075), (-3, 8, 0.075)], np.float32),
    "offset": np.array([0, 1, 3]),
    "path_rc": np.array([(20, 0), (20, 29)], np.int16),
    "path_offset": np.array([0, 1, 2]),
}


def save(folder, **changed):
    path = folder / "barn.npz"
    np.savez(path, **SMALL | changed)
    return path


def test_a_world_is_its_slice(tmp_path):
    path = save(tmp_path)
    assert barn_indices(path) == [0, 2]
    world = load_barn(2, path)
    np.testing.assert_allclose(world.circles, [(-2, 7, 0.075), (-3, 8, 0.075)], rtol=1e-6)
    np.testing.assert_allclose(world.reference, [START, (-1.575, 9.425), GOAL])
    arena = load_arena("barn:2", path=path)
    assert (arena.name, arena.start, arena.goal, arena.robot_radius) == ("barn:2", START, GOAL, 0.215)


def test_an_index_that_is_not_in_the_file(tmp_path):
    with pytest.raises(MapError, match=r"world 1 is not in BARN file .* 2 worlds from 0 to 2, the even numbers"):
        load_arena("barn:1", path=save(tmp_path))
    with pytest.raises(MapError, match=r"world 7 is not in .* from 0 to 3$"):
        load_barn(7, save(tmp_path, world=np.array([0, 3])))


@pytest.mark.parametrize(
    "changed",
    [
        {"xyr": SMALL["xyr"][:2]},
        {"xyr": SMALL["xyr"][:, :2]},
        {"offset": np.array([0, 3])},
        {"offset": np.array([0, 4, 3])},
        {"offset": np.array([1, 1, 3])},
        {"path_offset": np.array([0, 1, 3])},
        {"world": np.array(3)},
        {"world": np.array([], int), "offset": np.array([0])},
        {"xyr": np.full((3, 3), np.nan)},
        {"xyr": -np.ones((3, 3))},
        {"xyr": np.array([None] * 3)},
    ],
)
def test_arrays_that_do_not_fit_are_torn(tmp_path, changed):
    with pytest.raises(MapError, match=r"BARN file .* is torn") as refusal:
        load_barn(0, save(tmp_path, **changed))
    assert "\n" not in str(refusal.value)


def test_torn_and_missing_files(tmp_path):
    whole = save(tmp_path).read_bytes()
    torn = tmp_path / "torn.npz"
    for content in (b"", b"PK", whole[: len(whole) // 2], whole[:-30], b"not a zip at all", whole[:60] + whole[90:]):
        torn.write_bytes(content)
        with pytest.raises(MapError, match="is torn") as refusal:
            load_barn(0, torn)
        assert "\n" not in str(refusal.value)
    np.savez(torn, world=np.array([0]))
    with pytest.raises(MapError, match="needs the arrays world, xyr"):
        load_barn(0, torn)
    np.save(tmp_path / "one.npy", np.zeros(3))
    for path in (tmp_path / "one.npy", tmp_path):
        with pytest.raises(MapError, match="is torn or no"):
            load_barn(0, path)
    with pytest.raises(MapError, match="is not there"):
        load_barn(0, tmp_path / "none.npz")


@needs_barn
def test_reference_paths_have_the_published_lengths():
    published = json.loads((BARN.parent / "ref_path_length.json").read_text())["ref_path_length_m"]
    for index in barn_indices(BARN)[::15]:
        reference = load_barn(index, BARN).reference
        assert np.hypot(*np.diff(reference, axis=0).T).sum() == pytest.approx(published[str(index)], abs=0.001)


@needs_barn
def test_every_world_leaves_start_and_goal_free():
    assert barn_indices(BARN) == list(range(0, 300, 2))
    for index in barn_indices(BARN)[::15]:
        circles = load_barn(index, BARN).circles
        for end in (START, GOAL):
            assert (np.hypot(*(circles[:, :2] - end).T) - circles[:, 2]).min() > 0.215
