"""Without Ray, or with an address that is none, one sentence says so; clusters are tried in tests/evaluation."""

import os
import sys
from pathlib import Path

import pytest

from lidarena.base import ray_cluster
from lidarena.base.errors import ConfigError
from lidarena.base.ray_cluster import ray_results


def test_ray_may_not_be_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ConfigError, match=r"pip install 'lidarena\[ray\]'"):
        list(ray_results(abs, [1]))


@pytest.mark.parametrize(
    ("has_token", "told", "mode"), [(True, None, "token"), (False, None, None), (True, "disabled", "disabled")]
)
def test_a_clusters_token_is_offered_where_there_is_one(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, has_token: bool, told: str | None, mode: str | None
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    for name in ("RAY_AUTH_TOKEN", "RAY_AUTH_TOKEN_PATH", "RAY_AUTH_MODE"):
        monkeypatch.delenv(name, raising=False)
    if told is not None:
        monkeypatch.setenv("RAY_AUTH_MODE", told)
    if has_token:
        (tmp_path / ".ray").mkdir()
        (tmp_path / ".ray" / "auth_token").write_text("secret")
    ray_cluster._offer_token()
    assert os.environ.get("RAY_AUTH_MODE") == mode
