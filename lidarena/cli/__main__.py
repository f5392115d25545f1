"""``python -m lidarena.cli`` is the command ``lidarena``."""

import sys

from lidarena.cli import main

if __name__ == "__main__":
    sys.exit(main())
