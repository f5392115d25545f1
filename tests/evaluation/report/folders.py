"""A folder of results of the fake world, made once, for the tests of reports."""

from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from lidarena.base.yaml_config import check_config
from lidarena.evaluation.comparison import compare
from lidarena.evaluation.comparison_config import ComparisonConfig

HERE = "tests.evaluation.fake_world"


@cache
def results() -> Path:
    """Two policies in two corridors, six episodes each; not to be changed."""
    out = Path(mkdtemp()) / "corridors"
    envs = [{"id": f"{HERE}:fake/Corridor-v0", "name": name} for name in ("Corridor", "Other corridor")]
    policies = [{"name": f"{HERE}:Driver", "label": "driver"}, {"name": f"{HERE}:Crasher", "label": "crasher"}]
    content = {"envs": envs, "policies": policies, "episodes": 6, "workers": 1, "out": str(out)}
    return compare(check_config(content, ComparisonConfig)).folder
