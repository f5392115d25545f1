import numpy as np
import pytest

from lidarena.world.drawings import env1, env2, env3, env4
from lidarena.world.floorplan import Floorplan

SIZES = {env1: (5.0, 5.6), env2: (7.5, 7.5), env3: (8.9, 10.2), env4: (5.8, 8.8)}


@pytest.mark.parametrize(("draw", "size"), SIZES.items())
def test_circuits_have_the_sizes_that_the_authors_print(draw: object, size: tuple[float, float]) -> None:
    plan: Floorplan = draw()  # type: ignore[operator]
    assert plan.bounds == (0.0, 0.0, *size)
    x, y = plan.edges.reshape(-1, 2).T
    assert (x.min(), y.min(), x.max(), y.max()) == pytest.approx(plan.bounds)


@pytest.mark.parametrize("draw", [env1, env3, env4])
def test_symmetric_circuits_are_their_own_mirror_image(draw: object) -> None:
    """DA-SLAM's worlds look alike from many places, which is what makes them hard."""
    raster = draw().raster(0.05)  # type: ignore[operator]
    solid = raster.solid
    alike = [(solid == turned).mean() for turned in (solid[:, ::-1], solid[::-1], solid[::-1, ::-1])]
    assert max(alike) > 0.97


@pytest.mark.parametrize("draw", SIZES)
def test_the_robot_starts_in_the_open(draw: object) -> None:
    plan: Floorplan = draw()  # type: ignore[operator]
    assert plan.start is not None
    raster = plan.raster(0.05)
    column, row = ((np.array(plan.start[:2]) - raster.origin) / raster.resolution).astype(int)
    assert not raster.solid[row, column] and raster.clearance[row, column] > 0.25
