"""Shell completion: bash offers commands, options and the names of configurations."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from lidarena.cli import main
from lidarena.cli.config_names import shipped_names


def offered(script: str, *words: str) -> set[str]:
    """What bash offers for the last word."""
    line = " ".join(f"'{word}'" for word in words)
    code = f"{script}\nCOMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; COMPREPLY=(); _shtab_lidarena\n"
    code += 'printf "%s\\n" "${COMPREPLY[@]}"'
    done = subprocess.run(["bash", "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
def test_bash(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("shtab", reason="needs shtab, which lidarena[completion] installs")
    monkeypatch.chdir(tmp_path)
    assert main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    assert {"train", "evaluate"} <= offered(script, "lidarena", "")
    assert offered(script, "lidarena", "tr") == {"train"}
    assert offered(script, "lidarena", "train", "env1_comp") == {"env1_compass", "env1_completeness"}
    assert offered(script, "lidarena", "evaluate", "") == set(shipped_names("compare"))
    assert "--resume" in offered(script, "lidarena", "train", "--r")


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_get_a_script_that_knows_the_commands(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("shtab", reason="needs shtab, which lidarena[completion] installs")
    assert main(["completion", shell]) == 0
    assert "evaluate" in capsys.readouterr().out


def test_without_shtab_the_extra_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["completion", "bash"]) == 2
    assert "lidarena[completion]" in capsys.readouterr().err
