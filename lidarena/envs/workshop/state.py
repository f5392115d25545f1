"""The workshops themselves, batched: where everybody is and what is done; no spaces, rewards or episodes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.random_streams import seed_stream
from lidarena.envs.worker_threads import on_threads
from lidarena.envs.workshop.humans import EXTERNAL, choose_human, draw_traits
from lidarena.envs.workshop.kernels import NEAR, NOTHING, Rules, advance, settle, take_decisions
from lidarena.envs.workshop.options import PATIENCE, WorkshopOptions
from lidarena.envs.workshop.records import PICTURE_TICKS, Records, Workers, make_records, views_of
from lidarena.envs.workshop.task import HUMAN, ROBOT, WorkshopTask
from lidarena.envs.workshop.walking import TICK
from lidarena.world.robots import RobotSpec
from lidarena.world.team_physics import TeamPhysics

_LOG = 40
"""Changes of what somebody does that are noted for each action."""


class WorkshopCore:
    """``worlds`` workshops with a human and a robot each.

    World ``i`` depends on nothing but its own generator and actions.

    Args:
        worlds: Number of worlds.
        options: Checked keywords.

    Attributes:
        task: What is to be done.
        rules: What holds in all worlds.
        records: The state, for kernels.
        workers: The same as arrays.
        physics: The bodies.
        human: What the keyword asks for.
    """

    def __init__(self, worlds: int, options: WorkshopOptions) -> None:
        task = options.task
        assert isinstance(task, WorkshopTask)
        self.task, self.options, self.worlds = task, options, worlds
        self.human = choose_human(options.human)
        touch = sum(task.radii)
        patience = PATIENCE * max(task.deadline, float(task.arrays.tail.max()))  # a deadline too short binds nobody
        limit = patience if options.time_limit is None else options.time_limit
        outside = self.human == EXTERNAL or not isinstance(self.human, str)
        self.rules = Rules(touch + options.separation, touch, options.wait_period, limit, outside)
        spec = RobotSpec(radius=touch / 2.0, max_speed=max(task.speeds), substep=0.02)
        self.physics = TeamPhysics(worlds, 2, spec)
        self._pictures = 0 if options.render_mode is None else int(limit / TICK) // PICTURE_TICKS + 2
        self.records = _fresh(worlds, len(task.actions), self.physics.poses, self._pictures)
        self.workers: Workers = views_of(self.records)
        self._scratch = [np.zeros((2, 2)) for _ in range(64)]
        self.rngs: list[np.random.Generator | None] = [None] * worlds

    @property
    def time(self) -> NDArray[np.float64]:
        """(worlds,) since the episodes began [s]."""
        return np.asarray(self.workers.ticks * TICK, np.float64)

    def reset_world(self, world: int, rng: np.random.Generator) -> None:
        """Begin a new episode in one world; everything random is drawn from its generator."""
        s, task = self.workers, self.task
        kind = self.human if isinstance(self.human, str) else "free"
        traits, likes, refuses = draw_traits("free" if kind == EXTERNAL else kind, rng, task)
        fresh = _fresh(1, len(task.actions), np.zeros((1, 2, 3)), self._pictures)
        for array, first in zip(self.records, fresh, strict=True):
            array[world] = first[0]
        s.traits[world], s.likes[world], s.refuses[world] = traits, likes, refuses
        s.streams[world] = seed_stream(rng)
        self.rngs[world] = rng
        homes = task.grid.points[task.arrays.field[task.arrays.home, [HUMAN, ROBOT]]]
        poses = [(float(x), float(y), 0.0) for x, y in homes]
        self.physics.place(world, task.plan, poses)

    def decide(
        self, agent: int, choices: NDArray[np.int64], asked: NDArray[np.bool_], forced: bool = False
    ) -> NDArray[np.bool_]:
        """Let an agent begin an action or, with ``n``, wait, in those worlds where it is asked and has to decide.

        Args:
            agent: ``HUMAN`` or ``ROBOT``.
            choices: (worlds,) numbers of actions.
            asked: (worlds,).
            forced: Whether an action is begun that is open but not allowed.

        Returns:
            (worlds,) where it waits instead, since it may not do what it chose.
        """
        refused = np.zeros(self.worlds, np.bool_)
        take_decisions(self.task.arrays, self.records, self.rules, agent, choices, asked, forced, refused)
        return refused

    def run(self, active: NDArray[np.bool_]) -> None:
        """Let the active worlds run until somebody has to decide, or their episodes end."""
        going = active.copy()
        task, grid, s, rules = self.task.arrays, self.task.grid, self.records, self.rules
        while going.any():
            counter = np.zeros(1, np.int64)
            on_threads(
                min(self.worlds, len(self._scratch)),
                lambda thread: advance(task, grid, s, rules, going, counter, self._scratch[thread]),  # noqa: B023
            )
            going &= self.workers.verdict == NEAR
            if going.any():
                self._push(going)

    def _push(self, near: NDArray[np.bool_]) -> None:
        """Let pymunk move the two of some worlds by a tick."""
        s, before = self.workers, self.physics.poses.copy()
        s.commands[~near] = 0.0
        both = np.repeat(near[:, None], 2, axis=1)
        self.physics.advance(s.commands, TICK, both)
        self.physics.poses[~near] = before[~near]
        moved = np.hypot(*np.moveaxis(self.physics.poses[..., :2] - before[..., :2], 2, 0))
        s.path[near] += moved[near]
        s.contacts[near & self.physics.touched_robot.any(axis=1)] += 1
        settle(self.task.arrays, self.task.grid, self.records, self.rules, near)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Every array that makes up the worlds' state, by name; ``load_arrays`` writes them back.

        What was noted for pictures is not among them.
        """
        return {name: array for name, array in self.workers._asdict().items() if name != "trace"}

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of another core with the same options.

        Raises:
            ConfigError: They are those of another task.
        """
        for name, array in self.arrays().items():
            if saved[name].shape != array.shape:
                raise ConfigError(f"the saved state is of another task than {self.task.name!r}: {name!r} differs")
            array[...] = saved[name]
        for world in range(self.worlds):
            self.physics.furnish(world, self.task.plan)


def _fresh(worlds: int, count: int, poses: NDArray[np.float64], pictures: int) -> Records:
    """Worlds in which nobody has begun anything."""
    records = make_records(worlds, count, _LOG * count, poses, pictures)
    records.agents["action"] = NOTHING
    return records
