"""Comparing policies: episodes on all cores, means with intervals, tables, pictures and videos.

from lidarena.base.yaml_config import load_config
from lidarena.evaluation import ComparisonConfig, compare

comparison = compare(load_config("configs/compare/exploration.yaml", ComparisonConfig))
"""

from lidarena.evaluation.comparison import Comparison, compare
from lidarena.evaluation.comparison_config import ComparisonConfig
from lidarena.evaluation.episodes import Episode, run_episode
from lidarena.evaluation.measures.family_measures import FamilyMeasures
from lidarena.evaluation.measures.table_columns import Measure
from lidarena.evaluation.picture import Picture
from lidarena.evaluation.progress_curve import ProgressCurve
from lidarena.evaluation.recording import Recording
from lidarena.evaluation.results import Metric, Row
from lidarena.evaluation.runner import EpisodeError
from lidarena.evaluation.trace import RobotTrace, TeamTrace, Walls

__all__ = [
    "Comparison",
    "ComparisonConfig",
    "Episode",
    "EpisodeError",
    "FamilyMeasures",
    "Measure",
    "Metric",
    "Picture",
    "ProgressCurve",
    "Recording",
    "RobotTrace",
    "Row",
    "TeamTrace",
    "Walls",
    "compare",
    "run_episode",
]
