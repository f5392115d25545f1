"""What a report is made of: the content of a comparison that has just ended, or of a folder with results."""

import contextlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lidarena.base.errors import ConfigError, LidarenaError
from lidarena.base.import_names import import_named
from lidarena.envs.registration import registration_of
from lidarena.evaluation.comparison_config import file_name
from lidarena.evaluation.measures.family_measures import FamilyMeasures
from lidarena.evaluation.measures.table_columns import Measure
from lidarena.evaluation.replay import EpisodeReplay
from lidarena.evaluation.results import RESULTS_FILE, Metric, Row
from lidarena.evaluation.statistics import Interval

REPLAYS = "replays"
"""Folder of the replays, as ``ENVIRONMENT/POLICY.json.gz``."""


@dataclass(frozen=True)
class Player:
    """An episode to be played, and what stands above it."""

    env: str
    policy: str
    replay: EpisodeReplay


@dataclass(frozen=True)
class Figure:
    """A picture: PNG or SVG."""

    title: str
    data: bytes
    kind: str = "png"


@dataclass(frozen=True)
class ReportContent:
    """All that a page shows.

    Attributes:
        title: Above everything.
        rows: Of the tables; none of a training.
        facts: Sentences to open with, in place of the comparison's answer.
        figures: Pictures and curves.
        players: Episodes.
        details: Texts to be unfolded, by heading: the configuration, versions.
        missing: What should be there and is not, a sentence each.
    """

    title: str
    rows: Sequence[Row] = ()
    facts: Sequence[str] = ()
    figures: Sequence[Figure] = ()
    players: Sequence[Player] = ()
    details: Mapping[str, str] = field(default_factory=dict)
    missing: Sequence[str] = ()


def content_of_folder(folder: Path) -> ReportContent:
    """Read the results of a comparison; what is there is shown, what is missing is named.

    Raises:
        ConfigError: The folder does not exist, holds no results, or its ``results.json`` is torn.
    """
    document = read_results(folder)
    rows = rows_of(document)
    missing: list[str] = []
    players = _players(folder, rows, missing)
    figures = pictures_in(folder)
    if not figures:
        missing.append("there are no pictures (the folder 'pictures')")
    config = document.get("config", {})
    details = {"Configuration": _as_text(config), "Versions": _as_text(document.get("versions", {}))}
    return ReportContent(folder.resolve().name, rows, (), figures, players, details, missing)


def read_results(folder: Path) -> dict[str, Any]:
    """Read ``results.json``.

    Raises:
        ConfigError: See `content_of_folder`.
    """
    file = folder / RESULTS_FILE
    if not folder.is_dir():
        raise ConfigError(f"there is no folder {str(folder)!r}")
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except OSError:
        raise ConfigError(
            f"{str(folder)!r} holds neither {RESULTS_FILE} of an evaluation nor config.yaml of a training"
        ) from None
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        raise ConfigError(f"{str(file)!r} is torn: {error}") from None
    if not isinstance(document, dict) or not isinstance(document.get("rows"), list):
        raise ConfigError(f"{str(file)!r} is not of an evaluation: it has no list 'rows'")
    return document


def rows_of(document: Mapping[str, Any]) -> list[Row]:
    """Return the rows of a ``results.json``, with the columns of the families that measured them.

    Raises:
        ConfigError: A row lacks what every row has.
    """
    ids = {}
    for entry in document.get("config", {}).get("envs", []):
        ids[entry.get("name") or str(entry.get("id", "")).rpartition(":")[2].rpartition("/")[2]] = entry.get("id", "")
    try:
        return [_row(row, ids.get(row["env"], "")) for row in document["rows"]]
    except (AttributeError, KeyError, TypeError) as error:
        raise ConfigError(f"the results hold a row that is torn: {type(error).__name__} {error}") from None


def _row(row: Mapping[str, Any], env_id: str) -> Row:
    metrics = {}
    for name, found in row["metrics"].items():
        interval = Interval(*(_number(found[key]) for key in ("mean", "ci_low", "ci_high")))
        metrics[name] = Metric(interval, tuple(_number(value) for value in found["values"]))
    maps, failures = tuple(row.get("maps", ())), dict(row.get("failures", {}))
    return Row(row["env"], row["policy"], int(row["episodes"]), _columns(env_id, metrics), metrics, maps, failures)


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)


def _columns(env_id: str, names: Mapping[str, Any]) -> tuple[Measure, ...]:
    """The columns of a family; of one that is not known here any more, the bare names."""
    registered = registration_of(env_id)
    known: tuple[Measure, ...] = FamilyMeasures().table
    if registered is not None and registered[0].measures is not None:
        with contextlib.suppress(LidarenaError):  # of a package that is not installed here
            known = import_named(registered[0].measures, "the report").table
    listed = {column.name for column in known}
    return (*known, *(Measure(name, name, main=True) for name in names if name not in listed))


def pictures_in(folder: Path) -> list[Figure]:
    """The pictures of a comparison: overviews first, then those of each environment."""
    place = folder / "pictures"
    files = [*sorted(place.glob("*.png")), *sorted(place.glob("*/*.png"))]
    return [Figure(" · ".join(file.relative_to(place).with_suffix("").parts), file.read_bytes()) for file in files]


def replay_place(env: str, policy: str) -> Path:
    """Where the replay of an environment and a policy lies in the folder of the results."""
    return Path(REPLAYS) / file_name(env) / f"{file_name(policy)}.json.gz"


def _players(folder: Path, rows: Sequence[Row], missing: list[str]) -> list[Player]:
    players, lost = [], []
    for row in rows:
        try:
            players.append(Player(row.env, row.policy, EpisodeReplay.read(folder / replay_place(row.env, row.policy))))
        except ConfigError:
            lost.append(f"{row.policy} in {row.env}")
    if lost and players:
        missing.append(f"there is no episode to play of {', '.join(lost)}")
    elif lost:
        missing.append(f"there are no episodes to play (the folder {REPLAYS!r})")
    return players


def _as_text(value: Any) -> str:
    return json.dumps(value, indent=1, ensure_ascii=False)
