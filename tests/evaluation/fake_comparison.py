"""Comparisons of the drivers of the small corridor."""

from typing import Any

from lidarena.base.yaml_config import check_config
from lidarena.evaluation.comparison_config import ComparisonConfig

HERE = "tests.evaluation.fake_world"


def config_of(*policies: dict[str, Any], **keys: Any) -> ComparisonConfig:
    envs = [{"id": f"{HERE}:fake/Corridor-v0", "name": "Corridor", "keywords": keys.pop("keywords", {})}]
    content = {"envs": envs, "policies": list(policies), "episodes": 3, "seed": 10, **keys}
    return check_config(content, ComparisonConfig)


TWO = (
    {"name": f"{HERE}:Driver", "label": "driver"},
    {"name": f"{HERE}:Driver", "label": "hesitant", "options": {"back": 0.3}},
)
