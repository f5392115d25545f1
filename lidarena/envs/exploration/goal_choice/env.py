"""The environment of choosing where to explore next, and the batch of it."""

from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.base_env import SingleWorld, entry_point
from lidarena.envs.base_vector_env import SAME_STEP, BatchedWorlds, Mode, whole_number_of_worlds
from lidarena.envs.exploration.goal_choice.episodes import GoalChoiceEpisodes
from lidarena.envs.exploration.goal_choice.options import GoalChoiceKeywords, GoalChoiceOptions


class GoalChoiceEnv(SingleWorld):
    """Choose where to explore next.

    ## Description

    An exploration world (``lidarena/Exploration-v0``) in which the robot drives as the baseline ``frontier`` does. A
    step lasts until the next choice is due: after ``choice_period``, on arrival, when the chosen place has vanished or
    something new stands in the way. Candidates are the frontiers, nearest first, and places where the robot has been,
    where the pose becomes more certain. Where there is one candidate only, nobody is asked.

    ## Action space

    ``Discrete(candidates)``: which candidate to go to; one that is not there stands for the nearest
    frontier.
    ``action_masks()`` tells which are.

    ## Observation space

    ``Box(-60, 60, (candidates, 28 + candidates), float32)``: a row is a candidate, zeros where there is none. The first
    28 numbers are ``features.NAMES``, the others the lengths of the ways to every candidate / 6 m. The rows are a set:
    their order says nothing that the numbers do not say.

    ## Rewards

    Added up over the step, each times its weight in ``reward="preference"``; see ``GoalChoiceTerms``:

    | Term | Value | `preference` |
    |------|-------|------|
    | explored | gain in completeness | 5 |
    | path | minus the path driven, over that which is usual in a floor plan of this size | 1 |
    | time | minus 0.03 m for every second, over the same | 1 |
    | uncertainty | minus (0.05 + 2.5 preference) times the gain in completeness times ln(D / 1e-4) | 1 |
    | collision | -1 in the step of a collision | 5 |

    Nothing is paid for waiting or circling: only mapping, from poses as certain as the preference asks for.

    ## Starting state

    As in ``lidarena/Exploration-v0``, driven up to the first choice; the preference is drawn unless it is given.
    Where there is nothing to choose, as in a room that is seen at a glance, another episode is begun, up to five times;
    the last then ends in its first step.

    ## Episode end

    - Termination: a collision, or nothing is left: no frontier that can be reached, or nothing new for two minutes.
    - Truncation: after ``time_limit`` seconds, or ``max_episode_steps`` (2000) choices.

    ## Info

    ``completeness``, ``pose`` (3,), ``d_optimality``, ``path_length`` [m], ``time`` [s], ``collision``, ``success``
    (nothing is left), ``ending`` (why it has ended: ``"explored"``, ``"out of reach"`` where frontiers are left that
    cannot be reached, ``"fruitless"`` where nothing new came for two minutes; else empty), ``radius`` [m],
    ``preference``, ``action_mask``, ``reward_terms``; with ``expose_truth=True`` ``truth``.

    ## Arguments

    Those of ``lidarena/Exploration-v0`` that make its world, and, in full in ``GoalChoiceOptions``:

    | Name | Type | Default | Meaning |
    |------|------|---------|---------|
    | `preference` | float or str | `"random"` | how much certainty is worth, 0 to 1; or drawn for every episode |
    | `candidates` | int | `24` | most candidates that are told of |
    | `places` | int | `6` | known places among them, at most |
    | `least_frontier` | float | `0.4` | smallest frontier that is a candidate [m] |
    | `choice_period` | float | `2.0` | a choice may be changed so often [s] |
    | `time_limit` | float or None | `2000.0` | truncates [s] |
    | `reward` | str, dict or function | `"preference"` | see above |
    | `max_episode_steps` | int | `2000` | choices after which it truncates; -1 never |

    ## Version History

    - v0: since Lidarena 0.1. Since 0.2 worlds are a native batch, candidates are a set of any size with the ways
      between them, known places are among them, and there is a preference.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 5}  # noqa: RUF012 - as gym.Env declares it
    family = "exploration"

    @takes_keywords_of(GoalChoiceOptions, without=["world"])
    def __init__(self, **keywords: Unpack[GoalChoiceKeywords]) -> None:
        """Make one world.

        Raises:
            ConfigError: A keyword that is unknown or out of range.
            MapError: A floor plan or start that cannot be used.
        """
        super().__init__(GoalChoiceEpisodes(1, GoalChoiceOptions.checked(keywords)))

    def action_masks(self) -> NDArray[np.bool_]:
        """Which candidates are there (candidates,), as sb3-contrib's MaskablePPO asks for it."""
        return np.asarray(self.episodes.action_masks()[0])


class BatchedGoalChoice(BatchedWorlds):
    """``num_envs`` worlds of choices in one step; world ``i`` is ``GoalChoiceEnv`` with seed ``seed + i`` to the bit.

    All worlds drive at once until each needs its next choice; those that do wait for the others. See ``BatchedWorlds``.

    Args:
        num_envs: Number of worlds.
        autoreset_mode: What happens where an episode has ended, see ``BatchedWorlds``.
        keywords: Those of ``GoalChoiceEnv``.
    """

    family = "exploration"

    @takes_keywords_of(GoalChoiceOptions, without=["world"])
    def __init__(
        self, num_envs: int = 1, autoreset_mode: Mode = SAME_STEP, **keywords: Unpack[GoalChoiceKeywords]
    ) -> None:
        """Make the worlds; raises like ``GoalChoiceEnv``."""
        worlds = whole_number_of_worlds(num_envs)
        super().__init__(GoalChoiceEpisodes(worlds, GoalChoiceOptions.checked(keywords)), autoreset_mode)

    def action_masks(self) -> NDArray[np.bool_]:
        """Which candidates are there in every world (num_envs, candidates)."""
        return np.asarray(self.episodes.action_masks())


make_choice = entry_point(GoalChoiceEnv)
