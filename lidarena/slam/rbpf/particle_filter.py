"""Rao-Blackwellised particle filter: every particle a trajectory with its own map (Grisetti et al. 2007).

Between scans the particles follow the odometry with sampled noise. When the robot has moved, turned or waited enough,
each particle is matched against its own map and drawn anew from the Gaussian around the match (the improved proposal),
weighted by how well scan and odometry agree with its map, and the set is resampled only where N_eff has fallen
(selective resampling).
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.occupancy import OccupancyMaps, clear_map, empty_maps
from lidarena.slam.rbpf.filter_kernel import step_filter
from lidarena.slam.rbpf.particle_filter_state import FilterParameters, FilterState, Scratch, empty_scratch, empty_state
from lidarena.slam.readings import Reading, ScanGeometry


class ParticleFilters:
    """A batch of particle filters, one a world.

    Args:
        worlds: Number of filters.
        wanted: (plans, rows, columns) cells that count as covered once known; its shape is that of every grid.
        directions: (2, beams) cos and sin of the beams' angles.
        max_range: Ranges from here on are no returns [m].
        resolution: Side of a cell [m].
        parameters: Settings.

    Attributes:
        maps: The published occupancy grids, traced from each filter's best particle.
        state: The filters' arrays.
        scratch: What the kernel works on, a row for each thread.
    """

    def __init__(
        self,
        worlds: int,
        wanted: NDArray[np.uint8],
        directions: NDArray[np.float64],
        max_range: float,
        resolution: float = 0.05,
        parameters: FilterParameters | None = None,
    ) -> None:
        self.parameters = parameters or FilterParameters()
        self.resolution = resolution
        self.directions, self.max_range = directions, max_range
        rows, columns = wanted.shape[1:]
        self.maps: OccupancyMaps = empty_maps(worlds, wanted)
        self.state: FilterState = empty_state(worlds, rows, columns, directions.shape[1], self.parameters)
        self.scratch: Scratch = empty_scratch(worlds, rows, directions.shape[1], max_range, resolution, self.parameters)

    def start(self, world: int, plan: int, origin: NDArray[np.float64], pose: NDArray[np.float64]) -> None:
        """Start one filter anew; the next scan is its first.

        Args:
            world: Which filter.
            plan: Which of ``wanted`` it covers.
            origin: (2,) lower-left corner of its grids [m].
            pose: (3,) where the robot stands then; the frame of everything that follows.
        """
        clear_map(self.maps, world, plan, origin)
        self.state.particles[world] = pose
        self.state.updates[world] = 0

    def step(
        self,
        world: int,
        duration: float,
        reading: NDArray[np.float64],
        scan: NDArray[np.float32],
        stream: NDArray[np.uint64],
    ) -> None:
        """Advance one filter by an odometry reading (3,) and, where due, a scan (beams,); draws from ``stream`` (4,).

        Several filters at once, on all cores: ``filter_kernel.step_filter`` in a kernel of one's own.
        """
        geometry = ScanGeometry(self.directions, self.max_range, self.resolution)
        step_filter(
            world, Reading(duration, reading, scan, True), geometry, self.parameters, stream, self.state, self.maps,
            self.scratch, 0,
        )  # fmt: skip
