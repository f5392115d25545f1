"""A stand-in for the exploration environments: a world of solid cells, a perfect lidar, a perfect map.

It keeps to the environment's contract (actions, observations, info) but has no physics, no filter and no noise, unless
``pose_error`` asks for a slowly swaying error of the believed pose.
"""

import math
from typing import Any

import cv2
import gymnasium as gym
import numpy as np
from numba import njit

RESOLUTION = 0.05
MAX_RANGE = 3.5
BEAMS = 360
MARGIN = 0.3  # unknown border of the map (m)


@njit(cache=True, nogil=True)
def _cast(solid, x, y, heading, grid, ranges):
    """March all beams over ``solid`` in cells; mark ``grid`` (-1/0/100) and write ``ranges`` (m)."""
    step = 0.2
    for i in range(ranges.shape[0]):
        angle = heading + i * 2.0 * math.pi / ranges.shape[0]
        dx, dy = math.cos(angle) * step, math.sin(angle) * step
        u, v, travelled = x, y, 0.0
        ranges[i] = MAX_RANGE
        while travelled * RESOLUTION < MAX_RANGE:
            r, c = int(v), int(u)
            if r < 0 or c < 0 or r >= solid.shape[0] or c >= solid.shape[1]:
                break
            if solid[r, c]:
                grid[r, c] = 100
                ranges[i] = travelled * RESOLUTION
                break
            grid[r, c] = 0
            u += dx
            v += dy
            travelled += step


def drawn(*rows: str, side: int = 1) -> np.ndarray:
    """A world from a drawing, '#' solid, top row first (largest y); every character is ``side`` cells wide."""
    flat = np.array([[char == "#" for char in row] for row in rows])[::-1]
    return np.kron(flat, np.ones((side, side), bool)).astype(bool)


class FakeExploration(gym.Env):
    family = "exploration"
    metadata = {"render_modes": []}  # noqa: RUF012

    def __init__(self, solid, start, action="discrete", observation="da_slam", pose_error=0.0, stop_at=None):
        pad = round(MARGIN / RESOLUTION)
        self.solid = np.pad(np.asarray(solid, bool), pad, constant_values=True)
        self.origin = np.array([-MARGIN, -MARGIN])
        self.start, self.pose_error, self.kind, self.stop_at = start, pose_error, observation, stop_at
        self.discrete = action == "discrete"
        self.action_space = gym.spaces.Discrete(3) if self.discrete else gym.spaces.Box(-1, 1, (2,), np.float32)
        self.observation_space = gym.spaces.Box(0, 1, (7,), np.float32)
        free = (~self.solid).astype(np.uint8)
        self.clearance = (cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) - 0.5) * RESOLUTION
        self.worth = self._worth()

    def _worth(self):
        """Cells that count for completeness: free ones that the robot's disc can get near, and their walls."""
        passable = (self.clearance > 0.15).astype(np.uint8)
        _, labels = cv2.connectedComponents(passable, connectivity=4)
        home = labels == labels[self._cell(self.start[0], self.start[1])]
        region = cv2.dilate(home.astype(np.uint8), np.ones((7, 7), np.uint8)).astype(bool) & ~self.solid
        walls = cv2.dilate(region.astype(np.uint8), cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))).astype(bool)
        return region | (walls & self.solid)

    def _cell(self, x, y):
        return int((y - self.origin[1]) / RESOLUTION), int((x - self.origin[0]) / RESOLUTION)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.pose = np.array(self.start, float)
        self.grid = np.full(self.solid.shape, -1, np.int8)
        self.steps, self.path_length, self.least = 0, 0.0, math.inf
        self.trace = [self.pose.copy()]
        self._look()
        return self._observation(), self._info(False)

    def _look(self):
        self.ranges = np.empty(BEAMS)
        u, v = (self.pose[:2] - self.origin) / RESOLUTION
        _cast(self.solid, u, v, self.pose[2], self.grid, self.ranges)

    def _observation(self) -> Any:
        scan = (self.ranges / MAX_RANGE).astype(np.float32)
        if self.kind == "map":
            return {"scan": scan}
        return np.concatenate([scan[[0, 45, 90, 315, 270]], [0, 0]]).astype(np.float32)

    def _info(self, collision):
        sway = self.pose_error * np.array([math.sin(self.steps / 37), math.cos(self.steps / 53), 0.0])
        view = self.grid.view()
        view.flags.writeable = False
        return {
            "map": view,
            "resolution": RESOLUTION,
            "origin": self.origin,
            "pose": self.pose + sway,
            "covariance": np.eye(3) * 1e-4,
            "d_optimality": 1e-4 * (1 + self.path_length),
            "completeness": float((self.worth & (self.grid >= 0)).sum() / self.worth.sum()),
            "collision": collision,
            "time": 0.2 * self.steps,
            "path_length": self.path_length,
        }

    def step(self, action):
        if self.discrete:
            v, w = ((0.5, 0.0), (0.05, 0.3), (0.05, -0.3))[int(action)]
        else:
            assert self.action_space.contains(action), action
            v, w = 0.25 * (float(action[0]) + 1.0), float(action[1])
        collision = False
        for _ in range(5):
            self.pose[2] += w * 0.04
            self.pose[:2] += v * 0.04 * np.array([math.cos(self.pose[2]), math.sin(self.pose[2])])
            gap = float(self.clearance[self._cell(*self.pose[:2])])
            self.least = min(self.least, gap)
            collision |= gap < 0.12 - 0.5 * RESOLUTION  # the cell's centre may be half a cell nearer
        self.pose[2] = (self.pose[2] + math.pi) % (2 * math.pi) - math.pi
        self.path_length += v * 0.2
        self.steps += 1
        self.trace.append(self.pose.copy())
        self._look()
        info = self._info(collision)
        done = self.stop_at is not None and info["completeness"] >= self.stop_at
        return self._observation(), 0.0, collision or done, False, info


def explore(env, policy, steps, seed=0):
    """Drive until the policy is finished; returns the last info and the seconds that ``act`` took on average."""
    from time import perf_counter

    observation, info = env.reset(seed=seed)
    policy.reset(seed=seed)
    spent, n = 0.0, 0
    for _ in range(steps):
        begin = perf_counter()
        action = policy.act(observation, info)
        spent, n = spent + perf_counter() - begin, n + 1
        if getattr(policy, "finished", False):
            break
        observation, _, ended, _, info = env.step(action)
        if ended:
            break
    return info, spent / n
