"""TorchRL's PPO on an arena, and its wrapper around a team. Needs: pip install torchrl.

python examples/torchrl_ppo.py
"""

import torch
from tensordict.nn import NormalParamExtractor, TensorDictModule
from torch import nn
from torchrl.collectors import Collector
from torchrl.envs import GymEnv, PettingZooWrapper, RewardSum, TransformedEnv
from torchrl.modules import MLP, ProbabilisticActor, TanhNormal, ValueOperator
from torchrl.objectives import ClipPPOLoss
from torchrl.objectives.value import GAE

from lidarena.envs import corridor_v0

ARENA = {"action": "continuous", "observation": "proximity", "arena": "random", "max_episode_steps": 200}
BATCH, UPDATES, EPOCHS = 1000, 8, 8


def learners(env):
    """Return an actor and a critic for an environment."""
    sizes = {"in_features": env.observation_spec["observation"].shape[-1], "num_cells": [64, 64]}
    network = nn.Sequential(MLP(out_features=2 * env.action_spec.shape[-1], **sizes), NormalParamExtractor())
    moments = TensorDictModule(network, in_keys=["observation"], out_keys=["loc", "scale"])
    actor = ProbabilisticActor(
        moments, in_keys=["loc", "scale"], spec=env.action_spec, distribution_class=TanhNormal, return_log_prob=True
    )
    return actor, ValueOperator(MLP(out_features=1, **sizes), in_keys=["observation"])


if __name__ == "__main__":
    torch.manual_seed(0)
    env = TransformedEnv(GymEnv("lidarena:lidarena/Arena-v0", **ARENA), RewardSum())
    env.set_seed(0)
    actor, critic = learners(env)
    advantage = GAE(gamma=0.99, lmbda=0.95, value_network=critic)
    loss = ClipPPOLoss(actor, critic, entropy_coeff=1e-3)
    optimizer = torch.optim.Adam(loss.parameters(), 1e-3)
    for steps in Collector(env, actor, frames_per_batch=BATCH, total_frames=BATCH * UPDATES):
        for _ in range(EPOCHS):
            advantage(steps)
            for part in steps.reshape(-1)[torch.randperm(BATCH)].split(250):
                optimizer.zero_grad()
                sum(value for name, value in loss(part).items() if name.startswith("loss_")).backward()
                optimizer.step()
        ended = steps["next", "done"].squeeze(-1)
        returns = steps["next", "episode_reward"].squeeze(-1)[ended]
        print(f"{len(returns)} episodes, mean return {returns.mean():.1f}")
    team = PettingZooWrapper(corridor_v0.parallel_env(robots=3))
    print("a team's rewards", team.rollout(20)["next", "robot", "reward"].sum(0).squeeze(-1).tolist())
