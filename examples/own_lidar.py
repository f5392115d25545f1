"""A lidar and a robot of one's own in all three families: a slow scanner that looks ahead, on a box with two wheels.

python examples/own_lidar.py
"""

import math

import gymnasium as gym

import lidarena
from lidarena.envs import corridor_v0
from lidarena.world.lidar import LidarSpec
from lidarena.world.robots import RobotSpec

LIDAR = LidarSpec(beams=181, max_range=8.0, noise=0.005, field_of_view=math.radians(270), min_range=0.05, rate=2.5)
ROBOT = RobotSpec(outline=((0.15, 0.12), (-0.15, 0.12), (-0.15, -0.12), (0.15, -0.12)), max_speed=0.3)


def drive(env, policy, steps):
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    over = False
    while not (over or getattr(policy, "finished", False)) and steps > 0:
        observation, _, ended, cut_off, info = env.step(policy.act(observation, info))
        over, steps = ended or cut_off, steps - 1
    return info


if __name__ == "__main__":
    explorer = gym.make("lidarena/Env2-v0", robot=ROBOT, lidar=LIDAR, observation="sectors", action="continuous")
    info = drive(explorer, lidarena.baselines.make("frontier", explorer), 400)
    print(f"exploration: {info['completeness']:.0%} of the map in {info['time']:.0f} s, collision {info['collision']}")

    arena = gym.make("lidarena/Arena-v0", arena="random:1", robot={"radius": 0.8}, lidar={"beams": 90})
    info = drive(arena, lidarena.baselines.make("apf_improved_lidar", arena), 300)
    print(f"arena: {info['path_length']:.0f} m driven, success {info['success']}")

    fleet = corridor_v0.parallel_env(map="office", robots=2, robot="turtlebot3_waffle", lidar="hokuyo_urg_04lx")
    size, beams = fleet.options.robot.radius, fleet.options.lidar.beams
    print(f"corridor: robots of {size} m see {beams} beams")
