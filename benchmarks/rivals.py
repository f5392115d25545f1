"""Environment steps a second beside simulators that can be installed from PyPI: IR-SIM and VMAS.

pip install ir-sim vmas
python benchmarks/rivals.py [--seconds 10] [--env lidarena/Env1-v0]

The task is what all of them can do: one differential-drive robot with a lidar of 360 beams and 3.5 m range among the
walls of Env-1, 0.2 s a step. The rivals have perfect odometry and neither map nor SLAM; Lidarena is shown with the
true pose (`slam="truth"`: it maps) and live (the particle filter as well). A rival that is not installed is left out.
"""

import argparse
import importlib.util
import logging
import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from environment import Wanderer
from numpy.typing import NDArray

import lidarena
from lidarena.base.terminal import make_output_printable
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan

BEAMS, RANGE, RADIUS, PERIOD = 360, 3.5, 0.105, 0.2
COMMANDS = np.array([(0.5, 0.0), (0.05, 0.3), (0.05, -0.3)])
FRONT = np.array([0, 45, 90, 315, 270])
Step = Callable[[NDArray[np.int64]], NDArray[np.float32]]


def lidarena_step(env_id: str, worlds: int, **keywords: Any) -> Step:
    """A batch of Lidarena's worlds."""
    import gymnasium as gym

    envs = gym.make_vec(env_id, num_envs=worlds, vectorization_mode="vector_entry_point", **keywords)
    envs.reset(seed=0)
    return lambda actions: envs.step(actions)[0]


def irsim_step(plan: Floorplan) -> Step:
    """One world of IR-SIM, which has no batches."""
    import irsim

    low, high = plan.edges.reshape(-1, 2).min(axis=0), plan.edges.reshape(-1, 2).max(axis=0)
    beam = {"name": "lidar2d", "range_min": 0, "range_max": RANGE, "angle_range": 2 * np.pi, "number": BEAMS}
    world = {
        "world": {
            "width": float(high[0] - low[0]),
            "height": float(high[1] - low[1]),
            "offset": low.tolist(),
            "step_time": PERIOD,
            "sample_time": PERIOD,
            "collision_mode": "stop",
        },
        "robot": [
            {
                "kinematics": {"name": "diff"},
                "shape": {"name": "circle", "radius": RADIUS},
                "state": list(plan.start),
                "vel_max": [1, 1],
                "vel_min": [-1, -1],
                "sensors": [beam | {"noise": True, "std": 0.01}],
            }
        ],
        "obstacle": [
            {"shape": {"name": "linestring", "vertices": [[x1, y1], [x2, y2]]}, "state": [0, 0, 0]}
            for x1, y1, x2, y2 in plan.edges.tolist()
        ],
    }
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "world.yaml"
        file.write_text(yaml.safe_dump(world))
        env: Any = irsim.make(str(file), display=False, disable_all_plot=True, log_level="ERROR")

    def step(actions: NDArray[np.int64]) -> NDArray[np.float32]:
        env.step(COMMANDS[actions[0]].reshape(2, 1))
        ranges = np.asarray(env.get_lidar_scan()["ranges"])
        if env.robot.collision:
            env.reset()
        ahead = np.roll(ranges, -BEAMS // 2)  # its first beam points backwards
        return (ahead[FRONT] / RANGE).astype(np.float32)[None]

    return step


def vmas_step(plan: Floorplan, worlds: int) -> Step:
    """A batch of VMAS's worlds."""
    import torch
    from vmas import make_env
    from vmas.simulator.core import Agent, Landmark, Line, Sphere, World
    from vmas.simulator.dynamics.diff_drive import DiffDrive
    from vmas.simulator.scenario import BaseScenario
    from vmas.simulator.sensors import Lidar

    class Maze(BaseScenario):  # type: ignore[misc]  # untyped
        def make_world(self, batch_dim: int, device: Any, **_: Any) -> Any:
            world = World(batch_dim, device, dt=PERIOD, substeps=5)
            self.walls = []
            for k, (x1, y1, x2, y2) in enumerate(plan.edges.tolist()):
                wall = Landmark(f"wall{k}", collide=True, movable=False, shape=Line(float(np.hypot(x2 - x1, y2 - y1))))
                world.add_landmark(wall)
                self.walls.append((wall, ((x1 + x2) / 2, (y1 + y2) / 2), float(np.arctan2(y2 - y1, x2 - x1))))
            lidar = Lidar(world, n_rays=BEAMS, max_range=RANGE, entity_filter=lambda e: isinstance(e, Landmark))
            world.add_agent(
                Agent("robot", shape=Sphere(RADIUS), sensors=[lidar], dynamics=DiffDrive(world), u_range=[1.0, 1.0])
            )
            return world

        def reset_world_at(self, env_index: int | None = None) -> None:
            for wall, centre, angle in self.walls:
                wall.set_pos(torch.tensor(centre), batch_index=env_index)
                wall.set_rot(torch.tensor([angle]), batch_index=env_index)
            robot = self.world.agents[0]
            robot.set_pos(torch.tensor(plan.start[:2]), batch_index=env_index)
            robot.set_rot(torch.tensor([plan.start[2]]), batch_index=env_index)

        def observation(self, agent: Any) -> Any:
            return agent.sensors[0].measure()

        def reward(self, agent: Any) -> Any:
            return torch.zeros(self.world.batch_dim)

    env = make_env(Maze(), num_envs=worlds, device="cpu", continuous_actions=True, seed=0)
    env.reset()
    commands = torch.tensor(COMMANDS, dtype=torch.float32)

    def step(actions: NDArray[np.int64]) -> NDArray[np.float32]:
        ranges = env.step([commands[torch.from_numpy(actions)]])[0][0]
        for world in torch.nonzero(ranges.min(dim=1).values < 0.12).flatten().tolist():
            env.reset_at(world)
        seen: NDArray[np.float32] = (ranges[:, FRONT] / RANGE).numpy()
        return seen

    return step


def rate(step: Step, worlds: int, seconds: float) -> float:
    """Steps a second of all worlds, after a short run-up."""
    drive, observations = Wanderer(worlds), np.ones((worlds, 7), np.float32)
    for _ in range(5):
        observations = step(drive(observations))
    begin, steps = time.perf_counter(), 0
    while time.perf_counter() - begin < seconds:
        observations = step(drive(observations))
        steps += worlds
    return steps / (time.perf_counter() - begin)


def main() -> None:
    """Print the table."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--env", default="lidarena/Env1-v0")
    options = parser.parse_args()
    os.environ.setdefault("MPLBACKEND", "Agg")
    logging.disable(logging.WARNING)
    plan = load_floorplan(options.env.partition("/")[2].partition("-")[0].lower())
    rivals: list[tuple[str, int, Callable[[], Step]]] = [
        ("Lidarena, true pose", 64, lambda: lidarena_step(options.env, 64, slam="truth")),
        ("Lidarena, SLAM live", 64, lambda: lidarena_step(options.env, 64)),
        ("Lidarena, true pose", 1, lambda: lidarena_step(options.env, 1, slam="truth")),
        ("Lidarena, SLAM live", 1, lambda: lidarena_step(options.env, 1)),
    ]
    if importlib.util.find_spec("vmas"):
        rivals += [("VMAS", worlds, lambda worlds=worlds: vmas_step(plan, worlds)) for worlds in (64, 1)]  # type: ignore[misc]
    if importlib.util.find_spec("irsim"):
        rivals.append(("IR-SIM", 1, lambda: irsim_step(plan)))
    print(f"lidarena {lidarena.__version__}, {options.env}, {BEAMS} beams, {options.seconds:g} s each")
    print(
        f"{'simulator':22}{'worlds':>7}{'steps/s':>12}{'of VMAS, 64' if importlib.util.find_spec('vmas') else '':>14}"
    )
    found = [(name, worlds, rate(make(), worlds, options.seconds)) for name, worlds, make in rivals]
    unit = next((speed for name, worlds, speed in found if (name, worlds) == ("VMAS", 64)), None)
    for name, worlds, speed in found:
        print(f"{name:22}{worlds:7}{speed:12,.0f}{f'{speed / unit:13.1f}×' if unit else ''}")


if __name__ == "__main__":
    main()
