"""PPO in one file, in the manner of CleanRL, on a native batch: 64 arenas step in one call, no process a world.

python examples/cleanrl_ppo.py
"""

import gymnasium as gym
import numpy as np
import torch
from torch import nn
from torch.distributions import Normal

import lidarena  # noqa: F401 - registers the ids

WORLDS, STEPS, UPDATES, EPOCHS, BATCH = 64, 64, 16, 8, 1024
GAMMA, LAMBDA, CLIP, ENTROPY, RATE = 0.99, 0.95, 0.2, 1e-3, 1e-3


def network(inputs, outputs, last):
    """Two hidden layers; a small last one begins near zero."""
    layers = [nn.Linear(inputs, 64), nn.Tanh(), nn.Linear(64, 64), nn.Tanh(), nn.Linear(64, outputs)]
    for layer, gain in zip(layers[::2], (2**0.5, 2**0.5, last), strict=True):
        nn.init.orthogonal_(layer.weight, gain)
        nn.init.zeros_(layer.bias)
    return nn.Sequential(*layers)


class Agent(nn.Module):
    """A Gaussian actor and a critic."""

    def __init__(self, envs):
        super().__init__()
        inputs, outputs = envs.single_observation_space.shape[0], envs.single_action_space.shape[0]
        self.mean, self.critic = network(inputs, outputs, 0.01), network(inputs, 1, 1.0)
        self.log_std = nn.Parameter(torch.zeros(outputs))

    def distribution(self, observations):
        return Normal(self.mean(observations), self.log_std.exp())


def advantages(rewards, values, ended, cut_values, next_value):
    """Generalized advantage estimates; at a time limit the value of what was seen last stands for the rest."""
    found, carried = torch.zeros_like(rewards), torch.zeros(WORLDS)
    for t in reversed(range(STEPS)):
        following = (next_value if t == STEPS - 1 else values[t + 1]) * ~ended[t]
        error = rewards[t] + GAMMA * (following + cut_values[t]) - values[t]
        found[t] = carried = error + GAMMA * LAMBDA * ~ended[t] * carried
    return found


def last_values(agent, infos, truncated):
    """Critic's values of the last observations of the episodes that were cut off, else 0, (worlds,)."""
    values = torch.zeros(WORLDS)
    for world in np.flatnonzero(truncated):
        values[world] = agent.critic(torch.as_tensor(infos["final_obs"][world])).squeeze()
    return values


def learn(agent, optimizer, seen, actions, log_probs, gains, returns):
    """One update: some epochs of clipped steps on random batches."""
    for _ in range(EPOCHS):
        for part in torch.randperm(len(seen)).split(BATCH):
            distribution = agent.distribution(seen[part])
            ratio = (distribution.log_prob(actions[part]).sum(-1) - log_probs[part]).exp()
            gain = (gains[part] - gains[part].mean()) / (gains[part].std() + 1e-8)
            policy = -torch.min(ratio * gain, ratio.clamp(1 - CLIP, 1 + CLIP) * gain).mean()
            value = (agent.critic(seen[part]).squeeze(-1) - returns[part]).square().mean()
            optimizer.zero_grad()
            (policy + 0.5 * value - ENTROPY * distribution.entropy().sum(-1).mean()).backward()
            nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
            optimizer.step()


if __name__ == "__main__":
    torch.manual_seed(0)
    torch.set_num_threads(1)
    envs = gym.make_vec("lidarena/Arena-v0", num_envs=WORLDS, observation="proximity", max_episode_steps=200)
    agent = Agent(envs)
    optimizer = torch.optim.Adam(agent.parameters(), RATE, eps=1e-5)
    observation, _ = envs.reset(seed=0)
    earned, finished = np.zeros(WORLDS), []
    for update in range(UPDATES):
        seen, actions, log_probs, rewards, values, ended, cut = ([] for _ in range(7))
        for _ in range(STEPS):
            with torch.no_grad():
                tensor = torch.as_tensor(observation)
                distribution = agent.distribution(tensor)
                action = distribution.sample()
                seen, values = [*seen, tensor], [*values, agent.critic(tensor).squeeze(-1)]
                actions, log_probs = [*actions, action], [*log_probs, distribution.log_prob(action).sum(-1)]
                observation, reward, terminated, truncated, infos = envs.step(action.clamp(-1, 1).numpy())
                cut = [*cut, last_values(agent, infos, truncated & ~terminated)]
            done = terminated | truncated
            rewards, ended = [*rewards, torch.as_tensor(reward).float()], [*ended, torch.as_tensor(done)]
            earned += reward
            finished += earned[done].tolist()
            earned[done] = 0.0
        with torch.no_grad():
            next_value = agent.critic(torch.as_tensor(observation)).squeeze(-1)
            gains = advantages(*map(torch.stack, (rewards, values, ended, cut)), next_value)
            returns = gains + torch.stack(values)
        flat = [torch.stack(one).flatten(0, 1) for one in (seen, actions, log_probs)]
        learn(agent, optimizer, *flat, gains.flatten(), returns.flatten())
        if update % 5 == 0 or update == UPDATES - 1:
            mean = np.mean(finished[-100:]) if finished else float("nan")
            print(f"{(update + 1) * WORLDS * STEPS} steps, {len(finished)} episodes, mean return {mean:.1f}")
