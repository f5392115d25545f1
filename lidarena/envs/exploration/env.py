"""Active SLAM: a robot with a lidar explores an unknown world, its map and pose coming out of a particle filter."""

from typing import Any, Unpack

from gymnasium.error import ResetNeeded

from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.base_env import SingleWorld, entry_point
from lidarena.envs.base_vector_env import SAME_STEP, BatchedWorlds, Mode, whole_number_of_worlds
from lidarena.envs.exploration.episodes import ExplorationEpisodes
from lidarena.envs.exploration.options import ExplorationKeywords, ExplorationOptions
from lidarena.envs.exploration.state import ExplorationCore
from lidarena.world.floorplan import Floorplan


class ExplorationEnv(SingleWorld):
    """Explore an unknown world and map it, without losing track of where you are.

    ## Description

    A TurtleBot3 Burger (a disc of 0.105 m radius with a differential drive) starts at a known pose in an unknown floor
    plan. Its odometry drifts (gmapping's noise model); a 360-beam lidar of 3.5 m range and 1 cm noise feeds a
    Rao-Blackwellised particle filter, which estimates pose and map. Reward and observation are those of DA-SLAM
    (Alcalde et al. 2022), whose worlds are ``lidarena/Env1-v0`` … ``lidarena/Env4-v0``; ``lidarena/Exploration-v0``
    takes any floor plan. ``slam=`` puts another estimator in the filter's place: ``"odometry"``, ``"truth"``, or one's
    own, see ``lidarena.slam.estimator``.

    ## Action space

    ``action="discrete"``, ``Discrete(3)``, each for one decision period of 0.2 s:

    | Num | Action | speed [m/s] | turn rate [rad/s] |
    |-----|---------|------|------|
    | 0   | forward | 0.5  | 0    |
    | 1   | left    | 0.05 | 0.3  |
    | 2   | right   | 0.05 | -0.3 |

    ``action="continuous"``, ``Box(-1, 1, (2,), float32)``: speed 0.25 (a₀ + 1) m/s and turn rate a₁ · 1.0 rad/s.

    ## Observation space

    ``observation="da_slam"``, ``Box(0, 1, (7,), float32)``:

    | Num | Observation |
    |-----|-------------|
    | 0–4 | beams at 0, 45, 90, -45, -90 degrees, over the longest range |
    | 5   | previous action / 2 (continuous: two numbers, each mapped to [0, 1]) |
    | 6   | completeness |

    ``observation="sectors"``, ``Box(0, 1, (38,), float32)``: the same, except that 0–35 are the nearest hits in 36
    sectors of 10 degrees, the first one centred straight ahead, counter-clockwise. A wall's end between two of the five
    beams cannot hide from it.

    ``observation="frontier_histogram"``, ``Box(0, 1, (76,), float32)``, also says which way the edge of the known
    map lies:

    | Num   | Observation |
    |-------|-------------|
    | 0–35  | the radius and 0.015 m over the nearest hit in each of the same sectors |
    | 36–71 | to how much of the frontier each sector leads, around walls, see ``frontier_histogram`` |
    | 72–73 | (1 + cos) / 2, (1 + sin) / 2 of the mean direction of these; 0.5, 0.5 where there is none |
    | 74–75 | as 5 and 6 above |

    ``observation="frontier_arcs"``, ``Box(0, 1, (112,), float32)``, tells where a robot that can neither stop nor
    reverse still has room to turn:

    | Num    | Observation |
    |--------|-------------|
    | 0–35   | as in ``"frontier_histogram"`` |
    | 36–71  | to how much of the frontier each sector leads on ways that keep clear of things, see ``clear_ways`` |
    | 72–74  | (1 + cos) / 2, (1 + sin) / 2 of the direction of the nearest, and how near it is |
    | 75–109 | how far the robot could drive and turn before it touches what it sees, see ``free_arcs`` |
    | 110–111 | as 5 and 6 above |

    ``"da_slam_entropy"``, ``"sectors_entropy"``, ``"frontier_histogram_entropy"`` and ``"frontier_arcs_entropy"`` hold
    the entropy of the particles' weights / ln N in place of the completeness, as DA-SLAM's agent for uncertainty sees
    it.

    ``observation="map"``: a ``Dict`` of ``map``, ``scan``, ``covariance``, ``state``; see ``MapObserver``. Or an
    observer of one's own, see ``lidarena.envs.observers``.

    ## Rewards

    The sum of these terms, each times its weight; ``info["reward_terms"]`` holds them by name. ``reward`` takes a
    preset of weights, below, weights by term, or a function of one's own, see ``lidarena.envs.rewards``.

    | Term | Value | `completeness` | `d_optimality` | `combined` |
    |------|-------|------|------|------|
    | completeness | gain in completeness | 100 | | 10 |
    | d_optimality | 1 + tanh(η / D), D = det(Σ)^(1/3) of the pose's covariance | | 1 | |
    | path | minus the path driven, over that which is usual in a floor plan of this size | | | 1 |
    | uncertainty | minus the change of the mean of ln D, more in larger floor plans | | | 1 |
    | collision | -1 in the step of a collision | 100 | 100 | 10 |

    ``"completeness"`` and ``"d_optimality"`` are DA-SLAM's eqs. 2 and 3, in which the step of a collision earns nothing
    else; ``"combined"`` adds up to what a comparison measures. Completeness is the known share of K, the cells that the
    robot can come to know (``measure_coverage``). See ``ExplorationTerms``.

    ## Starting state

    The map's own start, ``start=(x, y, theta)``, or ``start="random"``: any reachable place some 0.25 m from the walls,
    any heading. The filter knows the start: its frame is the floor plan's.

    ## Episode end

    - Termination: something is nearer to the robot's centre than its ``collision_distance`` (0.12 m), or completeness
      reached ``stop_at``.
    - Truncation: after ``max_episode_steps`` (1000) steps, or after ``patience`` seconds (never) without 0.1% more.

    ## Info

    ``completeness``, ``pose`` (3,), ``covariance`` (3, 3) of it, ``d_optimality``; with ``slam="rbpf"`` the last is of
    the particles' own covariance, as in DA-SLAM, and the one before that of the pose, which is larger by a quarter to a
    half (``uncertainty.predictive_scale``); ``entropy`` of the weights [nat], ``n_eff``, ``entropy_gmapping``
    (DA-SLAM's "average uncertainty", see ``uncertainty.score_entropy``);
    ``path_length`` of the odometry [m], ``time`` [s], ``collision``, ``success`` (completeness reached ``stop_at``),
    ``radius`` of the robot [m], ``scan`` (beams,) measured ranges [m], ``odometry_pose`` (3,), ``reward_terms``;
    ``map`` (rows, columns) int8 with -1 unknown, 0 free, 100 occupied (in a batch a view that later steps change),
    ``resolution`` [m], ``origin`` (2,).
    What depends on the truth is ``completeness`` (and with it the reward), ``collision`` (a bumper) and, only with
    ``expose_truth=True``, ``truth``: ``pose`` and ``path_length``.

    ## Arguments

    In full: ``ExplorationOptions``.

    | Name | Type | Default | Meaning |
    |------|------|---------|---------|
    | `map` | str, plan, generator or list | `"willow_lobby"` | floor plan, or several from which every reset draws |
    | `reward` | str, dict or function | `"completeness"` | what a step is worth, see above |
    | `observation` | str or observer | `"da_slam"` | what is seen, see above |
    | `action` | str | `"discrete"` | or `"continuous"` |
    | `slam` | str, callable or dict | `"rbpf"` | estimator: also `"odometry"`, `"truth"`, or one's own |
    | `particles` | int | `30` | of the particle filter |
    | `robot` | str, dict or spec | `None` | a preset, changes to one, or a ``RobotSpec``; None: TurtleBot3 Burger |
    | `lidar` | str, dict or spec | `None` | the same with a ``LidarSpec``; None: 360 beams of 3.5 m, 1 cm of noise |
    | `odometry_noise` | float | `1.0` | factor on gmapping's motion noise; 0 is perfect odometry |
    | `decision_period` | float | `0.2` | time between decisions [s] |
    | `max_episode_steps` | int | `1000` | truncates; -1 never |
    | `start` | pose, str or None | `None` | (x, y, theta), `"random"`, or the map's own |
    | `stop_at` | float or None | `0.995` | completeness that ends an episode; None never |
    | `patience` | float or None | `None` | time without 0.1% more that truncates [s]; None never |
    | `expose_truth` | bool | `False` | give ``info["truth"]``, for evaluation |
    | `render_mode` | str or None | `None` | or `"rgb_array"` |
    | `eta` | float | `0.00012` | η of the term `d_optimality` [m^(4/3) rad^(2/3)] |
    | `certain_enough` | float | `0.00013` | D from which on down the term `uncertainty` pays no more |

    ## References

    Alcalde et al., DA-SLAM: Deep Active SLAM based on Deep Reinforcement Learning, LARS 2022. Grisetti, Stachniss,
    Burgard, Improved techniques for grid mapping with Rao-Blackwellized particle filters, T-RO 2007.

    ## Version History

    - v0: since Lidarena 0.1. Since 0.2 the reward never changes the observation: what ``reward="d_optimality"`` made of
      ``"da_slam"`` is ``"da_slam_entropy"``; ``"compass"`` is called ``"frontier_histogram"``; the covariance in
      ``observation="map"`` is scaled; ``weights`` are given in ``reward``; there are ``success``, ``radius``, ``scan``.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 5}  # noqa: RUF012 - as gym.Env declares it
    family = "exploration"

    @takes_keywords_of(ExplorationOptions)
    def __init__(self, **keywords: Unpack[ExplorationKeywords]) -> None:
        """Make one world; the keywords are those of ``ExplorationOptions``.

        Raises:
            ConfigError: A keyword that is unknown or out of range.
            MapError: A floor plan or start that cannot be used.
        """
        super().__init__(ExplorationEpisodes(1, ExplorationOptions.checked(keywords)))

    @property
    def floorplan(self) -> Floorplan:
        """The world's true floor plan, for pictures; no policy may look at it.

        Raises:
            ResetNeeded: Every episode draws another, and there was none.
        """
        core: ExplorationCore = self.episodes.core
        if not len(core.plans):
            raise ResetNeeded("there is no floor plan before reset()")
        return core.plans[int(core.plan[0])]


class BatchedExploration(BatchedWorlds):
    """``num_envs`` exploration worlds in one step; world ``i`` is ``ExplorationEnv`` with seed ``seed + i`` to the bit.

    See ``BatchedWorlds``; spaces, rewards and keywords: ``ExplorationEnv``.

    Args:
        num_envs: Number of worlds.
        autoreset_mode: What happens where an episode has ended, see ``BatchedWorlds``.
        keywords: Those of ``ExplorationOptions``.
    """

    family = "exploration"

    @takes_keywords_of(ExplorationOptions)
    def __init__(
        self, num_envs: int = 1, autoreset_mode: Mode = SAME_STEP, **keywords: Unpack[ExplorationKeywords]
    ) -> None:
        """Make the worlds; raises like ``ExplorationEnv``."""
        worlds = whole_number_of_worlds(num_envs)
        super().__init__(ExplorationEpisodes(worlds, ExplorationOptions.checked(keywords)), autoreset_mode)


make_single = entry_point(ExplorationEnv)
