"""The seabed: a vehicle whose odometry decides how often to compute where it is."""

from typing import Any, ClassVar, Unpack

from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.base_env import SingleWorld, entry_point
from lidarena.envs.base_vector_env import SAME_STEP, BatchedWorlds, Mode, whole_number_of_worlds
from lidarena.envs.seabed.episodes import SeabedEpisodes
from lidarena.envs.seabed.options import SeabedKeywords, SeabedOptions


class SeabedEnv(SingleWorld):
    """Choose when an underwater vehicle computes where it is.

    ## Description

    The world of Bobkov et al., who adapt the step of stereo visual odometry to the overlap of views. A vehicle flies a
    survey over a virtual seabed and takes 25 pairs of pictures a second with a stereo camera that looks down. Each
    decision says how many frames on the next position is computed, and whether the 6-cloud fit is spent on it. Few
    positions cost little and add up few errors; steps that are too long find too few features, and are refused: then
    nothing has changed but what was spent.

    ## Action space

    ``MultiDiscrete([16, 3])``: number of the skip in ``skips`` (1 to 96
    frames) or in ``overlaps``, if those are given, and what is spent: 0 a motion between two pairs, 1 the 6-cloud fit
    with a position in the middle, 2 the same, ending in the middle. From where a step was refused, the same or a longer
    one would be refused again: the longest of at most half of it is taken in its place, until a step is fine or the
    shortest was refused, too. (A refused 6-cloud fit leaves open whether two pairs alone would do.)

    ## Observation space

    ``Box(0, 10, (13,), float32)``; ``lidarena.envs.seabed.observations.NAMES`` names the numbers: matched features,
    overlap, height, speed, turning, uncertainty of position and heading, the last skip, whether it was refused, what it
    has cost, how many frames are left (96 at most), how many frames an overlap of 75% allows, share of features that
    matched.

    ## Rewards

    The sum of these terms, each times its weight; ``reward`` is as in all families.

    | Term | Value | `default` |
    |------|-------|------|
    | drift | minus the square of how far the error of the position has moved [cm²] | 4 |
    | compute | minus what the step has cost [0.1 s] | 1 |
    | refused | -1 where the step is refused | 0.05 |
    | progress | share of the flight that was covered | 0 |

    Errors of steps are independent, so that their squares add up to that of the end. What computing costs is counted,
    not timed, so that an episode is the same every time.

    ## Starting state

    The start of the survey, at a known pose; a seabed and a flight over it are drawn, see ``pick``.

    ## Episode end

    - Termination: the last frame of the flight is reached (``success``), or the vehicle touches the ground
      (``collision``).
    - Truncation: after ``max_episode_steps`` (5000) decisions.

    ## Info

    ``pose`` (3,) as computed, ``time`` of its frame [s], ``path_length`` [m], ``collision``, ``success``, ``radius``
    [m], ``frame``, ``frames_left``, ``skip`` of the last step, ``refused`` (the last step was), ``refusals``,
    ``positions`` computed so far, ``matches``, ``overlap``, ``height`` of the nearest ground seen [m], ``speed`` [m/s],
    ``uncertainty`` of the position [m], ``compute`` so far [s], ``reward_terms``. With ``expose_truth=True`` ``truth``:
    ``pose``, ``path_length``, ``error`` [m], ``clearance`` [m], ``nees``.

    ## Arguments

    In full: ``SeabedOptions``.

    | Name | Type | Default | Meaning |
    |------|------|---------|---------|
    | `scene` | str | `"scene1"` | or `"scene2"`; `"both"`: drawn for every episode |
    | `duration` | float or None | `None` | of the flight [s]; None: the scene's |
    | `speed` | float or None | `None` | [m/s]; None: the scene's |
    | `clearance` | two floats or None | `None` | least and greatest distance to the ground [m]; None: the scene's |
    | `seabeds` | int | `8` | how many different ones episodes draw from |
    | `pick` | str | `"random"` | which one a reset takes; `"by_seed"` the one of its seed |
    | `resolution` | str | `"600x400"` | or `"800x600"` |
    | `haze` | float | `0.03` | of the water [1/m] |
    | `noise` | float | `1.0` | deviation of a pixel's grey |
    | `features` | str | `"tracks"` | or `"sift"`, `"orb"` |
    | `count` | int | `300` | features that are looked for in an image |
    | `objective` | str | `"reprojection"` | or `"clouds"` |
    | `least_matches` | int | `40` | a step with fewer is refused |
    | `clip` | bool | `False` | look only at what two views have in common |
    | `angles` | str or None | `None` | `"fuse"` the measured attitude, or `"replace"` by it |
    | `compass_noise` | float | `0.1` | deviation of the attitude about each axis [degrees] |
    | `velocity_log` | bool | `False` | take the displacement of a Doppler log |
    | `skips` | list of int | `(1, 2, 3, 4, 6, 8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96)` | frames between positions |
    | `overlaps` | list of float or None | `None` | chosen instead of skips: shares that two views have in common |
    | `observation` | str or observer | `"navigation"` | what is seen |
    | `reward` | str, dict or function | `"default"` | what a step is worth |
    | `max_episode_steps` | int | `5000` | truncates; -1 never |
    | `expose_truth` | bool | `False` | give ``info["truth"]``, for evaluation |
    | `render_mode` | str or None | `None` | or `"rgb_array"` |

    ## References

    Bobkov, Melman, Tolstonogov, Shcherbatyuk, On some visual navigation algorithms of an autonomous underwater vehicle
    using stereo images (in Russian), 2017.

    ## Version History

    - v0: since Lidarena 0.2.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 5}  # noqa: RUF012 - as gym.Env has it
    family = "seabed"

    @takes_keywords_of(SeabedOptions)
    def __init__(self, **keywords: Unpack[SeabedKeywords]) -> None:
        """Make one world; the keywords are those of ``SeabedOptions``.

        Raises:
            ConfigError: A keyword that is unknown or out of range.
        """
        super().__init__(SeabedEpisodes(1, SeabedOptions.checked(keywords)))


class BatchedSeabed(BatchedWorlds):
    """``num_envs`` flights in one step; world ``i`` is ``SeabedEnv`` with seed ``seed + i`` to the bit.

    See ``BatchedWorlds``; spaces, rewards and keywords: ``SeabedEnv``.

    Args:
        num_envs: Number of worlds.
        autoreset_mode: What happens where an episode has ended, see ``BatchedWorlds``.
        keywords: Those of ``SeabedOptions``.
    """

    metadata: ClassVar[dict[str, Any]] = BatchedWorlds.metadata | {"render_fps": 5}  # type: ignore[misc]
    family = "seabed"

    @takes_keywords_of(SeabedOptions)
    def __init__(self, num_envs: int = 1, autoreset_mode: Mode = SAME_STEP, **keywords: Unpack[SeabedKeywords]) -> None:
        """Make the worlds; raises like ``SeabedEnv``."""
        worlds = whole_number_of_worlds(num_envs)
        super().__init__(SeabedEpisodes(worlds, SeabedOptions.checked(keywords)), autoreset_mode)


make_single = entry_point(SeabedEnv)
