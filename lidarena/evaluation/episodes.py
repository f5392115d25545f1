"""One episode: drive a policy through an environment, and let its family measure and draw it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np

from lidarena.base.errors import ConfigError
from lidarena.base.old_names import takes_old_keywords
from lidarena.baselines import Policy
from lidarena.envs.infos import Info
from lidarena.envs.registration import owner_of
from lidarena.evaluation.measures.family_measures import measures_of
from lidarena.evaluation.measures.table_columns import Measure
from lidarena.evaluation.picture import Picture
from lidarena.evaluation.progress_curve import ProgressCurve
from lidarena.evaluation.recording import Env, Recording
from lidarena.evaluation.replay import EpisodeReplay, ReplayRecorder


@dataclass(frozen=True)
class Episode:
    """What came of one episode.

    Attributes:
        seed: Of the environment.
        columns: Of the table, those of the environment's family.
        measures: Values by the columns' names, in SI units and fractions; NaN where the environment does not report
            what a measure needs.
        ending: Why it ended, see ``FamilyMeasures.ending``.
        caption: What was done and why it ended, in half a line.
        progress: How a measure rose or fell over time, if the family tells one.
        picture: To be drawn, if it was asked for and the family draws any.
        map: Of a folder of maps, which one.
        error: Why there is nothing, where a map of a folder could not be used; a sentence.
        replay: To be played in a report, if it was asked for and the environment tells poses.
    """

    seed: int
    columns: tuple[Measure, ...]
    measures: dict[str, float]
    ending: str
    caption: str = ""
    progress: ProgressCurve | None = None
    picture: Picture | None = None
    map: str | None = None
    error: str | None = None
    replay: EpisodeReplay | None = None


def policy_seed(seed: int) -> int:
    """Return the policy's seed for an environment's seed: another stream, so that their noises are independent."""
    return int(np.random.SeedSequence((seed, 1)).generate_state(1)[0])


def without_truth(info: Mapping[str, Any]) -> Info:
    """Return what a policy may see of an ``info``."""
    return Info({key: value for key, value in info.items() if key != "truth"})


@takes_old_keywords(keep_trace="keep_picture", film="record")
def run_episode(
    env: Env,
    policy: Policy,
    seed: int,
    *,
    max_steps: int | None = None,
    keep_picture: bool = False,
    keep_replay: bool = False,
    record: Callable[[Env], None] | None = None,
    watch: Callable[[Recording], None] | None = None,
) -> Episode:
    """Run one episode and measure it.

    Args:
        env: Made with ``expose_truth=True``, if it takes that; the truth is kept from the policy.
        policy: Who drives.
        seed: Of the environment; the policy gets `policy_seed` of it.
        max_steps: Stop here, if the environment does not end the episode before.
        keep_picture: Keep what is to be drawn.
        keep_replay: Keep what is to be played.
        record: Called with the environment after the reset and after every step, for a video.
        watch: Called with the recording each time it has noted an info, such as by a rosbag's writer.

    Returns:
        The measured episode.

    Raises:
        ConfigError: The environment is a batch, or its family is not registered, or tells measures that cannot be had.
    """
    if hasattr(env, "num_envs"):
        raise ConfigError(f"run_episode() runs in a single environment, not in {env.num_envs} at once")
    family = measures_of(env)
    recording = Recording(env, policy, family.kept)
    recording.step_limit = _step_limit(env, max_steps)
    recorder = ReplayRecorder() if keep_replay else None
    watchers = [one for one in (watch, recorder.note if recorder is not None else None) if one is not None]
    _drive(recording, seed, max_steps, record, watchers)
    recording.ending = family.ending(recording)
    values = family.values(recording)
    description = family.describe(values)
    return Episode(
        seed,
        family.table,
        values,
        recording.ending,
        f"{description}: {recording.ending}" if description else recording.ending,
        family.progress(recording),
        family.picture(recording) if keep_picture else None,
        replay=recorder.finish(recording) if recorder is not None else None,
    )


def _drive(
    recording: Recording,
    seed: int,
    max_steps: int | None,
    record: Callable[[Env], None] | None,
    watchers: Sequence[Callable[[Recording], None]],
) -> None:
    """Run the episode, noting what the family wants to be kept."""
    env, policy = recording.env, recording.policy

    def note(info: Mapping[str, Any]) -> None:
        recording.note(info)
        for watcher in watchers:
            watcher(recording)

    observation, info = env.reset(seed=seed)
    policy.reset(seed=policy_seed(seed))
    note(info)
    while not (recording.terminated or recording.truncated):
        if record:
            record(env)
        begin = perf_counter()
        action = policy.act(observation, without_truth(info))
        recording.decision_times.append(perf_counter() - begin)
        if getattr(policy, "finished", False):
            return
        observation, reward, terminated, truncated, info = env.step(action)
        recording.rewards.append(float(reward))
        note(info)
        recording.terminated = bool(terminated)
        recording.truncated = bool(truncated) or recording.steps == max_steps
    if record:
        record(env)


def _step_limit(env: Env, max_steps: int | None) -> float:
    """Steps after which an episode is cut off whatever happens; infinite if never.

    In Gymnasium's own limit None means none; in the environments' keyword and here, -1 does.
    """
    own = owner_of(env, "options")
    gymnasiums = None if env.spec is None else env.spec.max_episode_steps
    limits = (gymnasiums, getattr(own and own.options, "max_episode_steps", None), max_steps)
    return min((float(limit) for limit in limits if limit is not None and limit != -1), default=float("inf"))
