"""The picture of an episode in a workshop: who has done what when."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.workshop.kernels import AWAY, WAITING, WALKING, WORKING
from lidarena.envs.workshop.rendering import segments
from lidarena.evaluation.palette import AMBER, BLUE, GREY
from lidarena.evaluation.picture import Bounds
from lidarena.evaluation.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LANES = ("human", "robot")
_COLOURS = (AMBER, BLUE)


@dataclass(frozen=True)
class GanttChart:
    """Two lanes over time; a ``Picture`` whose x axis is seconds.

    Attributes:
        parts: (P, 5) agent, phase, action, begin and end [s], see ``rendering.segments``.
        actions: Names.
        deadline: [s].
        height: Of a lane, in seconds, so that the picture has a pleasant shape.
        axis_titles: Of x and y.
    """

    parts: NDArray[np.float64]
    actions: tuple[str, ...]
    deadline: float
    height: float
    axis_titles: tuple[str, str] = ("time (s)", "")

    @classmethod
    def of(cls, recording: Recording) -> "GanttChart | None":
        """Of a recorded episode; None if the environment does not tell its truth."""
        truth = recording.info.get("truth")
        task = getattr(recording.env.unwrapped, "task", None)
        if truth is None or task is None:
            return None
        end = float(recording.info["time"])
        parts = np.array(segments(truth["log"], int(truth["logged"]), end), np.float64).reshape(-1, 5)
        return cls(parts, task.actions, task.deadline, 0.14 * max(end, task.deadline))

    def bounds(self) -> Bounds:
        """From the beginning to the end, or the deadline."""
        end = max(self.deadline, float(self.parts[:, 4].max(initial=0.0)))
        return 0.0, end, 0.0, 2.8 * self.height

    def draw(self, axes: "Axes") -> None:
        """Draw a lane for each, the human's above, with the actions' names and the deadline."""
        from matplotlib.patches import Rectangle

        for agent, phase, action, begin, end in self.parts.tolist():
            colour, alpha = _look(int(phase), int(agent))
            if colour is None:
                continue
            low = (1.4 - 1.2 * agent) * self.height
            box = Rectangle((begin, low), end - begin, self.height, facecolor=colour, alpha=alpha, edgecolor="white")
            axes.add_patch(box)
            if phase == WORKING and action >= 0 and end - begin > 0.02 * self.bounds()[1]:
                name = self.actions[int(action)].replace("_", " ")
                axes.text(0.5 * (begin + end), low + 0.5 * self.height, name, rotation=90, ha="center", va="center",
                          fontsize=6, color="white")  # fmt: skip
        for agent, name in enumerate(_LANES):
            axes.scatter([], [], s=70, marker="s", color=_COLOURS[agent], label=f"{name} works")
        axes.scatter([], [], s=70, marker="s", color=BLUE, alpha=0.35, label="walks (pale)")
        axes.scatter([], [], s=70, marker="s", color=GREY, alpha=0.4, label="waits for the other")
        axes.scatter([], [], s=70, marker="s", color="black", label="away")
        axes.axvline(self.deadline, color="black", linestyle="--", linewidth=1.0, label="deadline")
        axes.set_yticks([(1.9 - 1.2 * agent) * self.height for agent in range(2)], _LANES)


def _look(phase: int, agent: int) -> tuple[str | None, float]:
    """Colour and opacity; None for idling."""
    looks: dict[int, tuple[str | None, float]] = {
        WORKING: (_COLOURS[agent], 1.0), WALKING: (_COLOURS[agent], 0.35), WAITING: (GREY, 0.4), AWAY: ("black", 0.8),
    }  # fmt: skip
    return looks.get(phase, (None, 0.0))
