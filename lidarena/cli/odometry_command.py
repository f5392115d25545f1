"""``lidarena odometry FOLDER``: stereo visual odometry of a recorded sequence."""

import argparse
import math
import sys
from pathlib import Path

from lidarena.base.keyword_checks import check_range
from lidarena.slam.logs.results_folder import check_folder
from lidarena.vision.recordings.reading import read_stereo
from lidarena.vision.recordings.sequence_odometry import SequenceOptions, SequenceResult, follow
from lidarena.vision.recordings.trajectory_errors import trajectory_errors
from lidarena.vision.recordings.trajectory_files import FILES, save_sequence


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's."""
    text = "Stereo visual odometry of a recorded sequence: KITTI's layout or EuRoC's."
    parser = commands.add_parser("odometry", help="stereo visual odometry of a recorded sequence", description=text)
    add = parser.add_argument
    add("folder", metavar="FOLDER", help="with calib.txt and folders of images (KITTI), or mav0/cam0 and cam1 (EuRoC)")
    add("--out", metavar="DIR", help="folder of the results; results/NAME if left out")
    add("--corners", type=int, default=700, metavar="N", help="that are tracked (default: %(default)s)")
    add("--window", type=int, default=6, metavar="N", help="frames that are fitted together (default: %(default)s)")
    add("--seed", type=int, default=0, metavar="N", help="of the random samples (default: %(default)s)")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Read and check everything, then do the work, then write."""
    check_range("corners", options.corners, 30, 5000, whole=True)
    check_range("window", options.window, 2, 30, whole=True)
    check_range("seed", options.seed, 0, 2**32, whole=True)
    out = Path(options.out or Path("results") / Path(options.folder).resolve().name)
    check_folder(out, FILES)
    recording = read_stereo(options.folder)
    camera, count = recording.camera, len(recording.files)
    print(f"sequence:   {count:,} pairs of {camera.width} x {camera.height} pixels, baseline {camera.baseline:.3f} m")
    chosen = SequenceOptions(count=options.corners, window=options.window)
    result = follow(recording, chosen, options.seed)
    errors = trajectory_errors(recording.truth, result.poses) if recording.truth is not None and count > 2 else None
    earlier = save_sequence(out, recording, result, errors)
    _warn(result)
    print(f"speed:      {count / max(result.seconds, 1e-9):.1f} frames a second of processor time")
    if errors is not None:
        lengths = ", ".join(f"{length:g}" for length in errors.lengths)
        rotation = math.degrees(errors.rotation)
        if errors.lengths:
            over = f"over parts of {lengths} m"
            print(f"relative:   {100 * errors.translation:.2f} % of the path, {rotation:.4f} degrees a metre, {over}")
        print(f"absolute:   ATE {errors.ate:.3f} m, at the end {errors.final:.3f} m, path {errors.path:.1f} m")
    print(f"results:    {out}/picture.png (also {', '.join(FILES[1:])})")
    if earlier is not None:
        print(f"earlier:    the results that stood there are now in {earlier}")


def _warn(result: SequenceResult) -> None:
    for number, why in list(result.unread.items())[:5]:
        print(f"warning:    frame {number} is left out: {why}", file=sys.stderr)
    if result.dropped:
        shown = ", ".join(map(str, result.dropped[:10])) + (", …" if len(result.dropped) > 10 else "")
        words = "the camera is taken to move on as before there"
        print(f"warning:    {len(result.dropped)} frames without a motion ({shown}); {words}", file=sys.stderr)
