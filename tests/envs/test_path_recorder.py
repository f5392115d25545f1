import numpy as np

from lidarena.envs.path_recorder import PathRecorder

POSES = np.array([[1.0, 2.0, 0.3], [4.0, 5.0, -0.3]])


def test_paths_are_kept_for_each_world_and_begin_with_an_episode() -> None:
    recorder = PathRecorder(2)
    recorder.begin(0, POSES)
    assert recorder.begun(0) and not recorder.begun(1)
    moving = np.stack([POSES, POSES + 1.0])
    recorder.record(moving)
    moving += 5.0  # what was recorded does not change
    assert recorder.paths(0).tolist() == [[pose[:2].tolist()] * 2 for pose in POSES]
    recorder.begin(0, POSES + 2.0)
    assert recorder.paths(0).tolist() == [[(pose[:2] + 2.0).tolist()] for pose in POSES]
