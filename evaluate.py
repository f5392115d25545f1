"""Compare policies from a YAML file; the same as ``lidarena evaluate``.

python evaluate.py --config configs/compare/exploration.yaml --set episodes=50 --out results/mine
"""

import sys

from lidarena.cli.evaluate_command import main

if __name__ == "__main__":
    sys.exit(main())
