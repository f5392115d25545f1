"""The README's code runs, and the files that it names are there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text()
SNIPPETS = re.findall(r"```python\n(.*?)```", README, re.DOTALL)


@pytest.mark.parametrize("code", SNIPPETS, ids=range(len(SNIPPETS)))
def test_the_readmes_code_runs(code: str, capsys: pytest.CaptureFixture[str]) -> None:
    namespace: dict[str, object] = {}
    exec(compile(code, "README.md", "exec"), namespace)
    assert namespace


def test_the_readme_has_code() -> None:
    assert len(SNIPPETS) >= 3


PATHS = sorted(set(re.findall(r"(?:configs|benchmarks|lidarena)/[\w/]+\.(?:yaml|py|md)", README)))


@pytest.mark.parametrize("path", PATHS)
def test_every_file_that_the_readme_names_exists(path: str) -> None:
    assert (ROOT / path).exists()
