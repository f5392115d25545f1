"""Train an agent from a YAML file, or go on with a training; the same as ``lidarena train``.

python train.py --config configs/train/env1_completeness.yaml --set ppo.n_steps=256 --out runs/mine
python train.py --resume runs/mine --set total_steps=8e6
"""

import sys

from lidarena.cli.train_command import main

if __name__ == "__main__":
    sys.exit(main())
