"""What the parts of stereo odometry cost on one core; the prices in ``lidarena/envs/seabed/compute.py`` are from here.

python benchmarks/seabed_compute.py
"""

import math
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np

from lidarena.base.random_streams import seed_stream
from lidarena.envs.seabed.options import SeabedOptions
from lidarena.envs.seabed.scenes import FrameStore, make_scene
from lidarena.vision.features import KINDS, FeatureOptions, detect
from lidarena.vision.matching import match_pairs
from lidarena.vision.motion import MotionOptions, estimate_motion
from lidarena.vision.rigid_motion import inverse

REPEATS = 6


def seconds(work: Callable[[], Any]) -> tuple[float, Any]:
    """The least processor time of some runs, since others use the machine too; and what came out."""
    found, least = work(), math.inf
    for _ in range(REPEATS):
        begun = time.process_time()
        found = work()
        least = min(least, time.process_time() - begun)
    return least, found


def main() -> None:
    """Measure and print."""
    cv2.setNumThreads(1)
    options = SeabedOptions.checked({"duration": 10.0})
    scene, camera = make_scene(options.kinds[0], 0), options.camera
    store = FrameStore(camera, options.water, FeatureOptions())
    spent, _ = seconds(lambda: store.images(scene, 0))
    print(f"rendering, 600 x 400: {1e3 * spent:.1f} ms a pair, {1 / spent:.0f} pairs a second")
    pairs = [store.images(scene, frame) for frame in (0, 40)]
    guess = inverse(scene.flight.poses[40]) @ scene.flight.poses[0]
    stream = seed_stream(np.random.default_rng(0))
    for kind in KINDS:
        features = FeatureOptions(kind=kind, count=300)
        detecting, found = seconds(lambda features=features: [detect(pair, camera, features) for pair in pairs])  # type: ignore[misc]
        work = lambda features=features, found=found: match_pairs(*found, camera, features, guess)  # noqa: E731
        matching, matches = seconds(work)
        fitting, fit = seconds(lambda matches=matches: estimate_motion(matches, camera, MotionOptions(), stream))  # type: ignore[misc]
        looked = sum(len(one.pixels) for one in found)
        print(
            f"{kind}: detecting {1e3 * detecting / 2:.1f} ms a pair, {detecting / 2 / (2 * 600 * 400):.2g} s a pixel; "
            f"matching {1e3 * matching:.1f} ms, {matching / looked:.2g} s a feature; fitting {1e3 * fitting:.1f} ms of "
            f"{len(matches.first)} matches, {int(fit.agree.sum())} agree"
        )


if __name__ == "__main__":
    main()
