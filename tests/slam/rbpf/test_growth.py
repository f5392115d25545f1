import numpy as np

from lidarena.slam.rbpf.growth import enlarged, tiles_missing
from lidarena.slam.rbpf.likelihood_field import TILE
from lidarena.slam.rbpf.particle_filter import ParticleFilters
from tests.slam.drive import FORWARD, Drive, ring, turn

GROWTH = (1, 2, 3, 0)


def cells(filters: ParticleFilters, particle: int) -> np.ndarray:
    """A particle's field as one array."""
    fields = filters.state.fields
    tiles = fields.tiles[0, fields.table[0, particle]][:, :, 1:-1, 1:-1]
    a, b = tiles.shape[:2]
    return tiles.transpose(0, 2, 1, 3).reshape(a * TILE, b * TILE)


def test_a_larger_grid_knows_the_same_and_has_its_tiles_in_order() -> None:
    drive = Drive(ring(), seed=1)
    drive.run([FORWARD] * 30)
    before, maps = [cells(drive.filters, i) for i in (0, 7, 29)], drive.filters.maps
    small = maps.occupancy[0].copy()
    filters = enlarged(drive.filters, *GROWTH)
    below, left, _, _ = (TILE * tiles for tiles in GROWTH)
    for i, field in zip((0, 7, 29), before, strict=True):
        grown = cells(filters, i)
        assert np.array_equal(grown[below : below + len(field), left : left + field.shape[1]], field)
        assert grown.astype(int).sum() == field.astype(int).sum()
    rows, columns = small.shape
    assert np.array_equal(filters.maps.occupancy[0][below : below + rows, left : left + columns], small)
    np.testing.assert_allclose(filters.maps.origin[0], drive.raster.origin - 0.05 * np.array([left, below]))
    fields = filters.state.fields
    used, free = set(np.unique(fields.table[0])) - {0}, fields.free[0, : fields.free_count[0]].tolist()
    assert len(free) == len(set(free)) == fields.free.shape[1] - 1 - len(used)
    assert not used & set(free)


def test_a_filter_goes_on_in_a_larger_grid_as_in_the_old_one() -> None:
    commands = [FORWARD] * 20 + turn(np.pi / 2) + [FORWARD] * 10
    drives = [Drive(ring(), seed=2), Drive(ring(), seed=2)]
    for drive in drives:
        drive.run([FORWARD] * 30)
    drives[1].filters = enlarged(drives[1].filters, *GROWTH)
    estimates = []
    for drive in drives:
        drive.run(commands)
        estimates.append(drive.filters.state.estimate[0].copy())
    np.testing.assert_allclose(estimates[0], estimates[1], atol=0.02)  # the origin differs, and with it roundings


def test_missing_tiles_reach_as_far_as_asked() -> None:
    rng = np.random.default_rng(0)
    for _ in range(100):
        origin, shape = rng.uniform(-5, 5, 2), (TILE * 5, TILE * 7)
        low, high = np.sort(rng.uniform(-20, 20, (2, 2)), axis=0)
        below, left, above, right = tiles_missing(origin, shape, 0.05, low, high)
        side = 0.05 * TILE
        assert (origin - side * np.array([left, below]) <= low + 1e-9).all()
        assert (origin + side * np.array([7 + right, 5 + above]) >= high - 1e-9).all()
        assert below == 0 or origin[1] - side * (below - 1) > low[1]
