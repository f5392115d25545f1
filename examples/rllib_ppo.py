"""RLlib's PPO on Env-1, from a process and workers that never imported Lidarena. Needs: pip install "ray[rllib]".

The module before the colon is what Gymnasium imports to find the id: lidarena:lidarena/Env1-v0.
"""

from ray.rllib.algorithms.ppo import PPOConfig

config = (
    PPOConfig()
    .environment("lidarena:lidarena/Env1-v0", env_config={"reward": "completeness", "max_episode_steps": 100})
    .env_runners(num_env_runners=1, num_envs_per_env_runner=2)
    .training(train_batch_size_per_learner=600, minibatch_size=128, num_epochs=4)
)

if __name__ == "__main__":
    trainer = config.build_algo()
    for iteration in range(3):
        result = trainer.train()["env_runners"]
        print(f"iteration {iteration}: {result['num_env_steps_sampled_lifetime']:.0f} steps", end=", ")
        print(f"return {result['episode_return_mean']:.1f} in {result['episode_len_mean']:.0f} steps")
    trainer.stop()
