"""The README is a first screen whose code runs; the files that it and the pages name are there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text()
PAGES = [README, *(page.read_text() for page in sorted((ROOT / "docs").rglob("*.md")))]
SNIPPETS = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
MOST_LINES = 150


@pytest.mark.parametrize("code", SNIPPETS, ids=range(len(SNIPPETS)))
def test_the_readmes_code_runs(code: str, capsys: pytest.CaptureFixture[str]) -> None:
    namespace: dict[str, object] = {}
    exec(compile(code, "README.md", "exec"), namespace)
    assert namespace


def test_the_readme_is_a_first_screen_with_code() -> None:
    assert len(SNIPPETS) >= 2 and README.count("\n") <= MOST_LINES


PATHS = sorted(
    {path for text in PAGES for path in re.findall(r"(?:configs|benchmarks|lidarena)/[\w/]+\.(?:yaml|py|md)", text)}
)


@pytest.mark.parametrize("path", PATHS)
def test_every_file_that_the_readme_or_a_page_names_exists(path: str) -> None:
    assert (ROOT / path).exists()
