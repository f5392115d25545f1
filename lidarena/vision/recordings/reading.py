"""Opens a recorded sequence in whichever layout its folder has."""

from pathlib import Path

from lidarena.base.errors import VisionError
from lidarena.vision.recordings.euroc import is_euroc, read_euroc
from lidarena.vision.recordings.kitti import FOLDERS, is_kitti, read_kitti
from lidarena.vision.recordings.recording import StereoRecording


def read_stereo(folder: str | Path) -> StereoRecording:
    """Open a sequence in KITTI's or EuRoC's layout.

    Raises:
        VisionError: It is in neither, or something is missing, torn, or does not fit together.
    """
    place = Path(folder)
    if not place.is_dir():
        raise VisionError(f"there is no folder {place}")
    if is_euroc(place):
        return _enough(read_euroc(place))
    if is_kitti(place):
        return _enough(read_kitti(place))
    pairs = ", ".join(f"{left} and {right}" for left, right, _ in FOLDERS)
    raise VisionError(
        f"{place} is no stereo sequence: allowed are calib.txt with folders {pairs} (KITTI), or mav0/cam0 and cam1 "
        "(EuRoC)"
    )


def _enough(recording: StereoRecording) -> StereoRecording:
    if len(recording.files) < 2:
        raise VisionError(f"{recording.name} has {len(recording.files)} pair of images; 2 at least are needed")
    return recording
