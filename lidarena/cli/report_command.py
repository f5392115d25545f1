"""``lidarena report DIR``: a page of an evaluation or of a training, in one file."""

import argparse
from pathlib import Path


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's."""
    text = "Write report.html of a folder of results or of a training: one file that needs no network."
    parser = commands.add_parser("report", help="a page of an evaluation or of a training", description=text)
    parser.add_argument("folder", metavar="DIR", help="with results.json (evaluate) or config.yaml (train)")
    parser.add_argument("--out", metavar="FILE", help="the page; report.html in the folder if left out")
    text = "drive no episode for the player, of a training; an evaluation has kept its own"
    parser.add_argument("--no-episode", action="store_true", help=text)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Write the page, and say what was missing for it.

    Raises:
        LidarenaError: There are no results, or the page cannot be written.
    """
    from lidarena.evaluation.report.folder_report import write_report  # here, since it takes seconds to load PyTorch

    out = Path(options.out) if options.out else None
    file, missing = write_report(Path(options.folder), out, episode=not options.no_episode)
    for sentence in missing:
        print(f"missing:  {sentence}")
    print(f"report:   {file}")
    return 0
