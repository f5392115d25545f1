"""Reports of folders: what ``evaluate`` writes at its end, and ``lidarena report DIR`` of any folder later."""

from dataclasses import replace
from pathlib import Path

from lidarena.agents.learning_curve import FILE as CURVE_FILE
from lidarena.agents.training_config import CONFIG_FILE
from lidarena.base.errors import ConfigError
from lidarena.evaluation.report.page import REPORT_FILE, write_page
from lidarena.evaluation.report.sources import Figure, content_of_folder, read_results
from lidarena.evaluation.report.training_report import content_of_training, curves_figure
from lidarena.evaluation.results import RESULTS_FILE


def write_report(folder: Path, out: Path | None = None, episode: bool = True) -> tuple[Path, list[str]]:
    """Write the report of a folder of results or of a training.

    Args:
        folder: With ``results.json`` or ``config.yaml``.
        out: File of the report; ``report.html`` in the folder if None.
        episode: Drive an episode with a trained agent, to be played in its report.

    Returns:
        The file, and a sentence for each thing that should be there and is not.

    Raises:
        ConfigError: The folder does not exist or holds neither, or its ``results.json`` is torn.
        WriteError: The report cannot be written.
    """
    target = out or folder / REPORT_FILE
    if not (folder / RESULTS_FILE).exists() and (folder / CONFIG_FILE).exists():
        content = content_of_training(folder, episode)
        return write_page(target, content), list(content.missing)
    return write_comparison_report(folder, target=target)


def write_comparison_report(
    folder: Path, title: str | None = None, target: Path | None = None
) -> tuple[Path, list[str]]:
    """Write the report of a folder of results; see ``write_report``.

    Args:
        folder: With ``results.json``.
        title: Above everything; the folder's name if None.
        target: File of the report; ``report.html`` in the folder if None.
    """
    content = content_of_folder(folder)
    content = replace(content, title=title or content.title, figures=[*_curves(folder), *content.figures])
    return write_page(target or folder / REPORT_FILE, content), list(content.missing)


def _curves(folder: Path) -> list[Figure]:
    """Learning curves of the agents that were compared, as far as their run folders are there."""
    policies = read_results(folder).get("config", {}).get("policies", [])
    paths = [Path(str(entry.get("path"))) for entry in policies if isinstance(entry, dict) and entry.get("path")]
    runs = [path for path in dict.fromkeys(paths) if (path / CURVE_FILE).is_file()]
    if not runs:
        return []
    try:
        return [curves_figure(runs)]
    except ConfigError:  # a training that is torn, or has no row yet, costs its curve
        return []
