from pathlib import Path

import pytest

from lidarena.base.errors import ConfigError
from lidarena.evaluation import compare


def test_a_dictionary_is_a_configuration_too(tmp_path: Path) -> None:
    envs = [{"id": "lidarena/Arena-v0", "keywords": {"arena": "random:1", "max_episode_steps": 5}}]
    content = {"envs": envs, "policies": ["random"], "episodes": 2, "pictures": False, "workers": 1}
    comparison = compare({**content, "out": str(tmp_path / "out")})
    assert [row.policy for row in comparison.rows] == ["random"] and comparison.rows[0].episodes == 2
    assert (comparison.folder / "table.md").exists()
    with pytest.raises(ConfigError, match=r"'polices'.*'policies'"):
        compare({**content, "polices": ["random"]})
