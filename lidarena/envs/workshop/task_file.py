"""What a task's YAML file holds: floor, locations, agents, actions, deadline, constraints; checked when it is read."""

import math
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from lidarena.base.errors import ConfigError, suggest
from lidarena.base.yaml_config import ConfigModel, check_config, load_config

AGENTS = ("human", "robot")
"""The two who share the floor, by their numbers."""
Agent = Literal["human", "robot"]
Point = Annotated[list[float], Field(min_length=2, max_length=2)]
Box = Annotated[list[float], Field(min_length=4, max_length=4)]
Bounds = Annotated[list[float], Field(min_length=2, max_length=2)]
MOST_ACTIONS = 24
_TASKS = Path(__file__).parent / "tasks"


class FloorConfig(ConfigModel):
    """The floor: drawn here, or a floor plan by its name or file.

    Attributes:
        map: What :func:`lidarena.world.load.load_floorplan` takes, in place of the rest.
        bounds: x_min, y_min, x_max, y_max; walls stand all around [m].
        walls: Further ones: centre lines x1, y1, x2, y2 [m], 0.1 m thick.
        boxes: Solid rectangles x1, y1, x2, y2 [m]: tables, shelves, machines.
    """

    map: str | None = None
    bounds: Box | None = None
    walls: list[Box] = Field(default_factory=list)
    boxes: list[Box] = Field(default_factory=list)

    @model_validator(mode="after")
    def _either(self) -> Self:
        if (self.map is None) == (self.bounds is None):
            raise ValueError("a floor needs either 'map' or 'bounds'")
        return self


class AgentConfig(ConfigModel):
    """One of the two workers.

    Attributes:
        home: Where it stands at the start, x, y [m].
        speed: At which it walks [m/s].
        radius: Of its body, a disc [m].
    """

    home: Point
    speed: float = Field(gt=0.05, le=5.0)
    radius: float = Field(default=0.25, ge=0.05, le=1.0)


class ActionConfig(ConfigModel):
    """One action.

    Attributes:
        at: The locations where it is worked at, one after the other.
        duration: Least and greatest time of the work, without walking, by the agents that can do it [s].
        after: Actions that must be finished before the work at the last location begins.
        shares: Of the work, at each location; equal ones if left out.
    """

    at: list[str] = Field(min_length=1, max_length=6)
    duration: dict[str, Bounds] = Field(min_length=1)
    after: list[str] = Field(default_factory=list)
    shares: list[Annotated[float, Field(gt=0.0, le=1.0)]] | None = None

    @field_validator("duration")
    @classmethod
    def _bounded(cls, duration: dict[str, list[float]]) -> dict[str, list[float]]:
        for agent, (lower, upper) in duration.items():
            if agent not in AGENTS:
                raise ValueError(f"there is no agent {agent!r}{suggest(agent, AGENTS)}")
            if not 0.0 < lower <= upper:
                raise ValueError(
                    f"the bounds of {agent!r} are [{lower:g}, {upper:g}], where 0 < lower <= upper is needed"
                )
        return duration

    @model_validator(mode="after")
    def _shared_out(self) -> Self:
        if self.shares is not None and (len(self.shares) != len(self.at) or abs(sum(self.shares) - 1.0) > 1e-6):
            raise ValueError(f"'shares' are {self.shares}, where one for each location is needed, together 1")
        return self


class ConstraintConfig(ConfigModel):
    """A bound on the time between two points, such as ``glue.end`` and ``door.start``.

    Attributes:
        start: ``from`` in a file.
        end: ``to`` in a file.
        lower: Least time [s]; None for none.
        upper: Greatest time [s]; None for none.
    """

    start: str = Field(alias="from")
    end: str = Field(alias="to")
    lower: float | None = None
    upper: float | None = None

    @model_validator(mode="after")
    def _bounded(self) -> Self:
        if self.lower is None and self.upper is None:
            raise ValueError("a constraint needs 'lower' or 'upper'")
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            raise ValueError(f"the lower bound {self.lower:g} is above the upper bound {self.upper:g}")
        return self


class TaskConfig(ConfigModel):
    """A task for a human and a robot.

    Attributes:
        title: For pictures.
        floor: The shared workspace.
        locations: By name: x, y [m], or such a point for each agent where they stand apart.
        agents: Both of them.
        actions: By name, in the order in which environments number them.
        deadline: For everything, from the start [s].
        constraints: Further ones.
    """

    title: str = ""
    floor: FloorConfig
    locations: dict[str, Point | dict[Agent, Point]] = Field(min_length=1)
    agents: dict[Agent, AgentConfig]
    actions: dict[str, ActionConfig] = Field(min_length=1, max_length=MOST_ACTIONS)
    deadline: float = Field(gt=0.0, le=1e6)
    constraints: list[ConstraintConfig] = Field(default_factory=list)

    @model_validator(mode="after")
    def _whole(self) -> Self:
        for agent in AGENTS:
            if agent not in self.agents:
                raise ValueError(f"the agent {agent!r} is missing; both human and robot are needed")
        for name, place in self.locations.items():
            if isinstance(place, dict) and set(place) != set(AGENTS):
                raise ValueError(f"the location {name!r} needs a point for each of human and robot, or one for both")
        self._check_actions()
        cycle = _cycle({name: action.after for name, action in self.actions.items()})
        if cycle:
            raise ValueError(f"the task graph has a cycle: {' → '.join(cycle)}; no order of these actions is possible")
        self._check_constraints()
        return self

    def _check_actions(self) -> None:
        for name, action in self.actions.items():
            if "." in name:
                raise ValueError(f"the action {name!r} must have no dot in its name")
            for location in action.at:
                if location not in self.locations:
                    wrong = f"the action {name!r} is at {location!r}, which is no location"
                    raise ValueError(wrong + suggest(location, self.locations))
            for earlier in action.after:
                if earlier not in self.actions:
                    wrong = f"the action {name!r} comes after {earlier!r}, which is no action"
                    raise ValueError(wrong + suggest(earlier, self.actions))

    def _check_constraints(self) -> None:
        for constraint in self.constraints:
            for point in (constraint.start, constraint.end):
                action, _, which = point.partition(".")
                if action not in self.actions:
                    raise ValueError(f"a constraint names {point!r}{suggest(action, self.actions)}")
                if which not in ("start", "end"):
                    raise ValueError(f"a constraint names {point!r}, where '{action}.start' or '{action}.end' is meant")


def _cycle(after: dict[str, list[str]]) -> list[str]:
    """Actions that wait for each other, in the order in which they would have to come; [] if there are none."""
    state: dict[str, int] = {}
    path: list[str] = []

    def visit(name: str) -> list[str]:
        if state.get(name) == 1:
            return [*path[path.index(name) :], name][::-1]
        if state.get(name) == 2:
            return []
        state[name] = 1
        path.append(name)
        for earlier in after[name]:
            found = visit(earlier)
            if found:
                return found
        path.pop()
        state[name] = 2
        return []

    return next((found for name in after if (found := visit(name))), [])


@cache
def built_in() -> tuple[str, ...]:
    """Names of the tasks that come with the package."""
    return tuple(sorted(file.stem for file in _TASKS.glob("*.yaml")))


def read_task(spec: Any) -> TaskConfig:
    """Read a task.

    Args:
        spec: A built-in name, a YAML file, a mapping that holds what such a file does, or a ``TaskConfig``.

    Raises:
        ConfigError: There is no such task or file, or something in it is wrong; one sentence.
    """
    if isinstance(spec, TaskConfig):
        return spec
    if isinstance(spec, dict):
        return check_config(spec, TaskConfig, origin="the task")
    if isinstance(spec, str) and spec in built_in():
        return load_config(_TASKS / f"{spec}.yaml", TaskConfig)
    if isinstance(spec, str | Path) and str(spec).endswith((".yaml", ".yml")):
        return load_config(spec, TaskConfig)
    raise ConfigError(f"task = {spec!r} is not known{suggest(str(spec), [*built_in(), 'a path to a .yaml file'])}")


def middle(bounds: list[float]) -> float:
    """The median of a log-normal duration between bounds: their geometric mean [s]."""
    return math.sqrt(bounds[0] * bounds[1])
