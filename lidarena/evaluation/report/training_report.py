"""The report of a training: what it reached, its learning curve, its configuration, and an episode of its agent."""

import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from lidarena.agents.learning_curve import FILE as CURVE_FILE
from lidarena.agents.training_config import CONFIG_FILE
from lidarena.base.errors import LidarenaError
from lidarena.base.yaml_config import read_yaml
from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.report.sources import Figure, Player, ReportContent
from lidarena.evaluation.reward_curves import Trainings, draw_curves
from lidarena.evaluation.runner import EpisodeError, run_tasks
from lidarena.evaluation.tasks import Task

SEED = 1_000_000
"""Of the episode that is driven for the report: none that a training begins with."""
_LONGEST = 5_000
_SHARES = {"completeness": "explored", "success_rate": "success", "collision_rate": "collisions"}


def content_of_training(folder: Path, episode: bool = True) -> ReportContent:
    """Read a run folder; what is there is shown, what is missing is named.

    Args:
        folder: With ``config.yaml``.
        episode: Drive an episode with the agent.

    Raises:
        ConfigError: ``config.yaml`` is torn.
    """
    config = read_yaml(folder / CONFIG_FILE)
    missing: list[str] = []
    rows = _curve(folder, missing)
    figures = [curves_figure([folder])] if rows else []
    card = _card(folder, missing)
    players = _episode(folder, config, missing) if episode and card is not None else []
    details = {"Configuration": (folder / CONFIG_FILE).read_text(encoding="utf-8")}
    if card is not None:
        told = {name: card.get(name) for name in ("training", "versions")}
        details["Policy"] = json.dumps(told, indent=1, ensure_ascii=False)
    return ReportContent(
        f"Training {folder.resolve().name}", (), _facts(config, rows), figures, players, details, missing
    )


def curves_figure(folders: Sequence[Path]) -> Figure:
    """Return the learning curves of trainings as SVG.

    Raises:
        ConfigError: A folder holds no learning curve.
    """
    import matplotlib

    stream = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "lidarena", "svg.fonttype": "none"}):
        draw_curves([Trainings(folder.name, [folder]) for folder in folders]).savefig(
            stream, format="svg", metadata={"Date": None}
        )
    text = stream.getvalue()
    return Figure("Learning curves", text[text.index("<svg") :].encode(), "svg")


def _curve(folder: Path, missing: list[str]) -> list[dict[str, str]]:
    try:
        with (folder / CURVE_FILE).open(encoding="utf-8", newline="") as stream:
            rows = [row for row in csv.DictReader(stream) if row.get("step")]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        missing.append(f"there is no learning curve ({CURVE_FILE}: {error})")
        return []
    if not rows:
        missing.append(f"the learning curve ({CURVE_FILE}) has no row yet")
    return rows


def _card(folder: Path, missing: list[str]) -> dict[str, Any] | None:
    try:
        card = json.loads((folder / "policy.json").read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError):
        missing.append("there is no policy yet (policy.json)")
        return None
    return card if isinstance(card, dict) else None


def _facts(config: Mapping[str, Any], rows: Sequence[Mapping[str, str]]) -> list[str]:
    """What the training reached, in two sentences."""
    env = config.get("env", {}).get("id", "an unknown environment")
    algorithm = config.get("algorithm", "PPO")
    if not rows:
        return [f"{algorithm} in {env}: nothing was recorded yet."]
    last = rows[-1]
    asked = config.get("total_steps")
    of = f" of {int(asked):,}" if isinstance(asked, int | float) else ""
    reached = [f"return {_value(last, 'episode_return'):.4g}"] if not math.isnan(_value(last, "episode_return")) else []
    for name, title in _SHARES.items():
        value = _value(last, name)
        reached += [] if math.isnan(value) else [f"{title} {100 * value:.1f}%"]
    steps, told = int(float(last["step"])), ", ".join(reached) or "no episode has ended"
    first = f"{algorithm} in {env}: {told} after {steps:,}{of} steps."
    best = max(rows, key=lambda row: (not math.isnan(_value(row, "episode_return")), _value(row, "episode_return")))
    second = f"Means over the last episodes of all worlds, one training seed ({config.get('seed')})."
    if not math.isnan(_value(best, "episode_return")):
        highest, step = _value(best, "episode_return"), int(float(best["step"]))
        second = f"The highest return was {highest:.4g} at step {step:,}. {second}"
    return [first, second]


def _value(row: Mapping[str, str], name: str) -> float:
    try:
        return float(row.get(name) or math.nan)
    except ValueError:
        return math.nan


def _episode(folder: Path, config: Mapping[str, Any], missing: list[str]) -> list[Player]:
    """An episode of the agent where it was trained, on a seed of its own."""
    keywords = {key: value for key, value in config["env"].get("keywords", {}).items() if key != "max_episode_steps"}
    try:
        env = EnvEntry(id=config["env"]["id"], keywords=keywords)
        policy = PolicyEntry(name=folder.resolve().name, path=str(folder))
        task = Task(env, policy, SEED, max_steps=_LONGEST, keep_replay=True)
        (found,) = run_tasks([task], workers=1)
    except (LidarenaError, EpisodeError, KeyError, ValueError) as error:
        missing.append(f"no episode could be driven: {error}")
        return []
    if found.replay is None:
        missing.append("the environment tells no poses, so there is no episode to play")
        return []
    return [Player(env.label, f"{policy.title}: {found.caption}", found.replay)]
