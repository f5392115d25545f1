"""Lidarena: 2D robot worlds with lidar and SLAM in the loop, learned agents and classical baselines on one interface.

Importing the package registers every environment id with Gymnasium. ``lidarena.baselines`` is at hand at once;
``lidarena.agents`` and ``lidarena.evaluation`` load PyTorch and Matplotlib and are therefore imported when first used.
"""

import importlib
from types import ModuleType

from lidarena import baselines
from lidarena.base.old_names import keep_old_names
from lidarena.envs import register_all

__all__ = ["agents", "baselines", "evaluation"]
__version__ = "0.1.0"

keep_old_names()
register_all()


def __getattr__(name: str) -> ModuleType:
    """Import the heavy rooms on first use."""
    if name in ("agents", "evaluation"):
        return importlib.import_module(f"lidarena.{name}")
    raise AttributeError(f"module 'lidarena' has no attribute {name!r}")
