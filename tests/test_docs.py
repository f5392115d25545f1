"""The pages of docs/: their code runs, their commands are known, their YAML is read, and the site builds strictly."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import matplotlib
import pytest
import yaml
from matplotlib import pyplot

from lidarena.cli import _program
from lidarena.cli.config_names import find_config

ROOT = Path(__file__).parent.parent
PAGES = sorted((ROOT / "docs").rglob("*.md"))
TEXTS = {page.relative_to(ROOT).as_posix(): page.read_text(encoding="utf-8") for page in [ROOT / "README.md", *PAGES]}
YAML_BLOCKS = [(page, text) for page in TEXTS for text in re.findall(r"```yaml\n(.*?)```", TEXTS[page], re.DOTALL)]
COMMAND = re.compile(r"^(?:\$ )?((?:lidarena|python (?:train|evaluate)\.py) .*)$", re.MULTILINE)


def commands() -> list[tuple[str, str]]:
    """Every line of the program in a block without a language, with its page."""
    found = []
    for page, text in TEXTS.items():
        for language, block in re.findall(r"^```(\w*)\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
            lines = COMMAND.findall(block) if not language else []
            found += [(page, line.partition(" #")[0].strip()) for line in lines]
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_pages_code_runs(page: Path, capsys: pytest.CaptureFixture[str]) -> None:
    matplotlib.use("Agg")
    namespace: dict[str, object] = {}
    for code in re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        exec(compile(code, page.name, "exec"), namespace)
    pyplot.close("all")


@pytest.mark.parametrize(("page", "line"), commands())
def test_the_commands_of_the_pages_are_known(page: str, line: str) -> None:
    """Options and shipped configurations are there; the work itself is other tests'."""
    words = shlex.split(line.removeprefix("python "))
    if words[0] == "lidarena":
        if words[1:2] == ["--version"]:
            return
        options = _program()[0].parse_args(words[1:])
        kinds = {"train": "train", "evaluate": "compare"}
        if options.command in kinds and options.name and "." not in options.name:
            find_config(kinds[options.command], options.name)  # type: ignore[arg-type]
    else:
        options = _program()[0].parse_args([words[0].removesuffix(".py"), *words[1:]])
    if getattr(options, "config", None) and options.config.startswith("configs/"):
        assert (ROOT / options.config).is_file()


@pytest.mark.parametrize(("page", "text"), YAML_BLOCKS)
def test_the_yaml_of_the_pages_is_read(page: str, text: str) -> None:
    assert isinstance(yaml.safe_load(text), dict)


def test_there_is_something_to_check() -> None:
    assert len(PAGES) >= 5 and len(commands()) >= 10 and len(YAML_BLOCKS) >= 1


@pytest.mark.parametrize("page", TEXTS)
def test_links_between_the_pages_lead_somewhere(page: str) -> None:
    for target in re.findall(r"\]\(([^)#]+?)(?:#[^)]*)?\)", TEXTS[page]):
        if "://" not in target:
            assert ((ROOT / page).parent / target).exists(), f"{page} links to {target}"


def test_the_site_builds_strictly(tmp_path: Path) -> None:
    pytest.importorskip("mkdocs", reason="needs mkdocs, which lidarena[docs] installs")
    pytest.importorskip("mkdocstrings", reason="needs mkdocstrings, which lidarena[docs] installs")
    # not quietly: MkDocs counts only those warnings that it would have shown
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path / "site")]
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "ExplorationEnv" in (tmp_path / "site" / "api" / "index.html").read_text()
    for page in PAGES:
        name = "index.html" if page.stem == "index" else f"{page.stem}/index.html"
        assert (tmp_path / "site" / name).is_file()
