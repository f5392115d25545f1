"""The code in the pages of docs/ runs, one page after its own earlier blocks."""

import re
from pathlib import Path

import matplotlib
import pytest
from matplotlib import pyplot

PAGES = sorted((Path(__file__).parent.parent / "docs").glob("*.md"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_pages_code_runs(page: Path, capsys: pytest.CaptureFixture[str]) -> None:
    matplotlib.use("Agg")
    namespace: dict[str, object] = {}
    for code in re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        exec(compile(code, page.name, "exec"), namespace)
    pyplot.close("all")
