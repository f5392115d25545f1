"""Without Ray, or with an address that is none, one sentence says so; clusters are tried in tests/evaluation."""

import sys

import pytest

from lidarena.base.errors import ConfigError
from lidarena.base.ray_cluster import ray_results


def test_ray_may_not_be_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ConfigError, match=r"pip install 'lidarena\[ray\]'"):
        list(ray_results(abs, [1]))
