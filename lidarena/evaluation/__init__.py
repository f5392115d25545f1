"""Comparing policies: episodes on all cores, means with intervals, tables, pictures and videos.

from lidarena.base.yaml_config import load_config
from lidarena.evaluation import ComparisonConfig, compare

comparison = compare(load_config("configs/compare/exploration.yaml", ComparisonConfig))
"""

from lidarena.evaluation.comparison import Comparison, compare
from lidarena.evaluation.comparison_config import ComparisonConfig
from lidarena.evaluation.episodes import Episode, run_episode
from lidarena.evaluation.results import Metric, Row
from lidarena.evaluation.runner import EpisodeError

__all__ = ["Comparison", "ComparisonConfig", "Episode", "EpisodeError", "Metric", "Row", "compare", "run_episode"]
