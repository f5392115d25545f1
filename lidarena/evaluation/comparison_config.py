"""The comparison file: which policies are measured in which environments, and how often."""

from collections import Counter
from itertools import product
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from lidarena.base.yaml_config import ConfigModel
from lidarena.evaluation.map_folders import MapCase, MapFolder

EVALUATION_KEYWORDS = ("expose_truth", "render_mode")
"""Keywords of the environments that the evaluation itself sets."""
Engine = Literal["processes", "ray"]
SHIPPED = "pretrained:"
"""What the names of shipped agents begin with."""


def _named(key: str) -> BeforeValidator:
    """Let a plain text stand for a section with one key."""
    return BeforeValidator(lambda value: {key: value} if isinstance(value, str) else value)


def _fill(value: Any, seed: int) -> Any:
    """A keyword's value with the episode's seed for ``{seed}``."""
    return value.replace("{seed}", str(seed)) if isinstance(value, str) else value


class EnvEntry(ConfigModel):
    """One environment of a comparison.

    Attributes:
        id: Gymnasium's, such as ``lidarena/Env1-v0``; ``module:id`` imports a module of yours first.
        name: What tables and pictures call it; the id without its namespace if left out.
        keywords: Handed to `gymnasium.make`, such as ``map`` or ``max_episode_steps``. ``{seed}`` in a text stands for
            the seed of the episode: with ``map: "maze:{seed}"`` every episode has a maze of its own.
        maps: A folder of maps (its path, or a section with ``path`` and ``starts``) in place of a ``map``: one episode
            a map, reported together as one kind of world. A map that is broken costs nothing but itself.
        episodes: Here; those of the comparison if left out. Of a folder so many maps, spread over the names; all of
            them if left out.
    """

    id: str = Field(min_length=1)
    name: str | None = None
    keywords: dict[str, Any] = Field(default_factory=dict)
    maps: Annotated[MapFolder, _named("path")] | None = None
    episodes: int | None = Field(default=None, ge=1, le=100_000)

    @model_validator(mode="after")
    def _the_folder_says_the_map(self) -> Self:
        for key in ("map", *(["start"] if self.maps is not None and self.maps.starts is not None else [])):
            if self.maps is not None and key in self.keywords:
                raise ValueError(f"{self.id!r} has a folder of maps and the keyword {key!r}; leave one out")
        return self

    @model_validator(mode="after")
    def _leave_the_evaluation_its_own(self) -> Self:
        for key in EVALUATION_KEYWORDS:
            if key in self.keywords:
                raise ValueError(f"the keyword {key!r} of {self.id!r} is set by the evaluation itself, so leave it out")
        return self

    def of_episode(self, seed: int, case: MapCase | None = None) -> "EnvEntry":
        """The entry with the seed of an episode filled in, and the map where there is a folder of them."""
        keywords = {key: _fill(value, seed) for key, value in self.keywords.items()}
        return self.model_copy(update={"keywords": keywords | (case.keywords if case is not None else {})})

    @property
    def label(self) -> str:
        """What tables and pictures call it."""
        return self.name or self.id.rpartition(":")[2].rpartition("/")[2]


class PolicyEntry(ConfigModel):
    """One policy of a comparison.

    Attributes:
        name: Of a baseline (`lidarena.baselines.names`), or ``module:callable`` for a policy of yours, called with the
            environment and the options; ``pretrained:NAME`` for a shipped agent. With ``path``, any name you like for
            the trained agent.
        path: Run folder of a trained agent, or ``pretrained:NAME``, as `lidarena.agents.load` reads it.
        options: Keyword arguments of the baseline, or of what drives by the agent's network.
        sweep: Values of options to try one after the other, ``{preference: [0, 0.5, 1]}``: each makes a policy of its
            own, called such as ``combined @ 0.5``. In the plane they are the points of one line.
        keywords: Of the environment, for this policy alone, over those of the environment's entry: an agent that was
            trained on another ``observation`` or ``reward`` needs the same here.
        label: What tables and pictures call it; ``name`` if left out.
        line: Policies of the same line are joined in the plane; those of a sweep are, if it is left out.
    """

    name: str = Field(min_length=1)
    path: str | None = None
    options: dict[str, Any] = Field(default_factory=dict)
    sweep: dict[str, list[Any]] = Field(default_factory=dict)
    keywords: dict[str, Any] = Field(default_factory=dict)
    label: str | None = None
    line: str | None = None

    @model_validator(mode="before")
    @classmethod
    def _shipped_agents_by_name(cls, value: Any) -> Any:
        name = value.get("name") if isinstance(value, dict) else None
        if isinstance(name, str) and name.startswith(SHIPPED) and value.get("path") is None and name != SHIPPED:
            return value | {"name": name.removeprefix(SHIPPED), "path": name}
        return value

    @model_validator(mode="after")
    def _sweeps_have_values(self) -> Self:
        for key, values in self.sweep.items():
            if key in self.options:
                raise ValueError(f"policy {self.name!r} gives {key!r} in its options and in its sweep; leave one out")
            if not values or any(value in values[:place] for place, value in enumerate(values)):
                raise ValueError(f"the sweep of {key!r} of policy {self.name!r} needs values, each of them once")
        for key in EVALUATION_KEYWORDS:
            if key in self.keywords:
                raise ValueError(f"the keyword {key!r} of policy {self.name!r} is set by the evaluation itself")
        return self

    @property
    def title(self) -> str:
        """What tables and pictures call it."""
        return self.label or self.name

    def swept(self) -> list["PolicyEntry"]:
        """The policies that the sweep makes of it, one of each combination of values; itself without a sweep."""
        if not self.sweep:
            return [self]
        return [self._at(dict(zip(self.sweep, values, strict=True))) for values in product(*self.sweep.values())]

    def _at(self, values: dict[str, Any]) -> "PolicyEntry":
        update = {
            "options": self.options | values,
            "sweep": {key: [value] for key, value in values.items()},
            "label": f"{self.title} @ {', '.join(map(str, values.values()))}",
            "line": self.line or self.title,
        }
        return self.model_copy(update=update)


class ComparisonConfig(ConfigModel):
    """A comparison file.

    Attributes:
        envs: The environments; a plain id stands for an entry without keywords.
        policies: The policies; a plain name stands for a baseline without options. The first is the one that the
            others are compared with pair by pair.
        keywords: Of every environment, under those of its own entry.
        episodes: Per environment and policy, where the environment's entry does not say otherwise.
        seed: Episode k of every policy runs on seed + k, so that policies meet the same worlds.
        pictures: Draw the first episode of each, an overview and the progress over time (PNG).
        report: Write ``report.html``, with the first episode of each to be played.
        videos: Record the first episode of each: ``mp4``, ``gif``, or false.
        record: Write the first episode of each as a rosbag 2 (MCAP) into ``bags``.
        out: Folder of the results.
        workers: Processes; one per core if left out.
        engine: ``processes`` of this machine, or ``ray`` (``pip install 'lidarena[ray]'``) for a cluster, whose nodes
            have this package, and read the same maps and agents. It changes no result, so it is not written down.
        ray_address: Of the cluster, as ``ray.init`` takes it; ``RAY_ADDRESS`` if left out, and without that the cores
            of this machine.
    """

    envs: list[Annotated[EnvEntry, _named("id")]] = Field(min_length=1)
    policies: list[Annotated[PolicyEntry, _named("name")]] = Field(min_length=1)
    keywords: dict[str, Any] = Field(default_factory=dict)
    episodes: int = Field(default=20, ge=1, le=100_000)
    seed: int = Field(default=0, ge=0, lt=2**31)
    pictures: bool = True
    report: bool = True
    videos: Literal["mp4", "gif", False] = False
    record: bool = False
    out: str = Field(default="results/comparison", min_length=1)
    workers: int | None = Field(default=None, ge=1, le=1024)
    engine: Engine = Field(default="processes", exclude=True)
    ray_address: str | None = Field(default=None, exclude=True)

    @model_validator(mode="after")
    def _labels_tell_entries_apart(self) -> Self:
        _refuse_twins([env.label for env in self.envs], "environments", "name")
        _refuse_twins([policy.title for policy in self.participants], "policies", "label")
        return self

    @model_validator(mode="after")
    def _leave_the_evaluation_its_own(self) -> Self:
        for key in EVALUATION_KEYWORDS:
            if key in self.keywords:
                raise ValueError(f"the keyword {key!r} is set by the evaluation itself, so leave it out")
        return self

    @property
    def worlds(self) -> list[EnvEntry]:
        """The environments, with the keywords that are said of all."""
        return [env.model_copy(update={"keywords": self.keywords | env.keywords}) for env in self.envs]

    @property
    def participants(self) -> list[PolicyEntry]:
        """The policies, those of sweeps one by one."""
        return [one for policy in self.policies for one in policy.swept()]

    @property
    def folder(self) -> Path:
        """Folder of the results."""
        return Path(self.out)

    def seeds(self, env: EnvEntry) -> range:
        """Seeds of the episodes in an environment, the same for every policy."""
        return range(self.seed, self.seed + len(self.cases(env)))

    def cases(self, env: EnvEntry) -> list[MapCase | None]:
        """The map of each episode in an environment; None where its keywords say which.

        Raises:
            ConfigError: A folder of maps that cannot be used.
        """
        return [None] * (env.episodes or self.episodes) if env.maps is None else [*env.maps.cases(env.episodes)]


def file_name(label: str) -> str:
    """Return a label without what file systems dislike."""
    return "".join(sign if sign.isalnum() or sign in "-_." else "-" for sign in label).lstrip(".") or "-"


def _refuse_twins(labels: list[str], what: str, key: str) -> None:
    """Refuse labels that are equal, or would be as names of files (where case may not count)."""
    counts = Counter(file_name(label).casefold() for label in labels)
    for label in labels:
        if counts[file_name(label).casefold()] > 1:
            raise ValueError(f"two {what} are called {label!r} or nearly so; give each its own {key!r}")
