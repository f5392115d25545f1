"""The particle filter as an environment's estimator, ``slam="rbpf"``."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.base.keyword_checks import check_range
from lidarena.slam.estimator import BatchEstimator, EstimatorSettings, Floats, map_arrays
from lidarena.slam.occupancy import OccupancyMaps
from lidarena.slam.rbpf.filter_kernel import step_filter
from lidarena.slam.rbpf.likelihood_field import Fields, tiles_in_use
from lidarena.slam.rbpf.particle_filter import ParticleFilters
from lidarena.slam.rbpf.particle_filter_state import FilterParameters, FilterState, Scratch
from lidarena.slam.rbpf.scan_points import points_for
from lidarena.slam.readings import ScanGeometry, Share, next_world, reading_of
from lidarena.slam.uncertainty import COVARIANCE_FLOOR, predictive_scale
from lidarena.world.sensors import Sensing, sense

MOST_PARTICLES = 1000
"""So many particles a filter can have."""


class ParticleFilterEstimator(BatchEstimator):
    """Rao-Blackwellised particle filters (Grisetti et al. 2007), one a world.

    Args:
        settings: What it is made for.
        particles: N.
        resample_share: Resample when N_eff falls below this share of N.

    Raises:
        ConfigError: An option out of range.
    """

    def __init__(self, settings: EstimatorSettings, *, particles: int = 30, resample_share: float = 0.5) -> None:
        check_range("particles", particles, 1, MOST_PARTICLES, whole=True)
        check_range("resample_share", resample_share, 0.0, 1.0)
        self.settings = settings
        parameters = FilterParameters(
            particles=particles, resample_share=float(resample_share), noise=settings.noise,
            points=points_for(settings.lidar.increment),
        )  # fmt: skip
        self.filters = ParticleFilters(
            settings.worlds, settings.wanted, settings.directions, settings.lidar.max_range, settings.resolution,
            parameters,
        )  # fmt: skip
        state = self.filters.state
        self.maps, self.estimate, self.covariance = self.filters.maps, state.estimate, state.covariance
        self.d_optimality, self.particles = state.criteria[:, 0], state.particles

    def start(self, world: int, plan: int, origin: Floats, pose: Floats, rng: np.random.Generator) -> None:
        """Start one filter anew; the next scan is its first."""
        self.filters.start(world, plan, origin, pose)
        self.filters.state.estimate[world] = pose

    def sense_and_estimate(self, sensing: Sensing, share: Share) -> None:
        """Read the sensors and run the filters of world after world."""
        filters = self.filters
        arguments = (
            sensing, share, self.geometry, filters.parameters, filters.state, filters.maps,
            filters.scratch,
        )  # fmt: skip
        self._pass_of(sense_and_filter, arguments)(*arguments)

    def scaled_entropy(self) -> NDArray[np.float64]:
        """Entropy of the particles' weights over its maximum ln N, (worlds,) in [0, 1]."""
        most = math.log(max(self.filters.parameters.particles, 2))
        return np.clip(self.filters.state.criteria[:, 1] / most, 0.0, 1.0)

    def infos(self) -> dict[str, NDArray[Any]]:
        """What only a filter can tell.

        ``covariance`` of the pose given the particles, which is more than theirs (``uncertainty.predictive_scale``);
        ``entropy`` of the weights [nat], ``n_eff``, and ``entropy_gmapping`` (``uncertainty.score_entropy``).
        """
        criteria, floor = self.filters.state.criteria, np.diag(COVARIANCE_FLOOR)
        scale = predictive_scale(self.filters.state.weights)[:, None, None]
        told = {name: criteria[:, k].copy() for k, name in enumerate(("entropy", "n_eff", "entropy_gmapping"), 1)}
        return {"covariance": scale * (self.covariance - floor) + floor} | told

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The maps, the particles' likelihood fields, and the filters."""
        state = self.filters.state._asdict()
        fields: Fields = state.pop("fields")
        named = map_arrays(self.maps) | {f"fields.{name}": array for name, array in fields._asdict().items()}
        named["fields.tiles"] = fields.tiles[:, : tiles_in_use(fields)]  # the rest was never written, or is stale
        return named | {f"filter.{name}": array for name, array in state.items()}

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other filters with the same options."""
        self.filters.state.fields.references[...] = saved["fields.references"]  # how many tiles there are to load
        super().load_arrays(saved)


@leaf
def sense_and_filter(
    sensing: Sensing,
    share: Share,
    geometry: ScanGeometry,
    parameters: FilterParameters,
    state: FilterState,
    maps: OccupancyMaps,
    scratch: Scratch,
) -> None:
    """Read the sensors and run the particle filter, world after world."""
    w = next_world(share)
    while w < share.last:
        sense(w, sensing)
        step_filter(
            w, reading_of(w, sensing), geometry, parameters, sensing.streams[w], state, maps, scratch, share.thread
        )
        w = next_world(share)
