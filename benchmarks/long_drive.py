"""Kilometres of driving in one building: whether the time a scan and the graph stop growing once it is known.

python benchmarks/long_drive.py [--length 10000] [--number 1]

The way, wheels and laser are those of ``benchmarks/simulated_logs.py``; scans are given to ``Mapper.add`` one by one.
For each kilometre the processor time a scan, the nodes of the graph and how far the pose is off are printed, and in the
end the last kilometre's time a scan over the third's, what finishing takes, and the peak of the memory.
"""

import argparse
import resource
import time

import numpy as np
from simulated_logs import compare, simulated_log

from lidarena.base.terminal import make_output_printable
from lidarena.slam.graph.mapper import Mapper
from lidarena.slam.planar import between


def main() -> None:
    """Drive and map."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--length", type=float, default=10_000.0, help="of the way [m], about")
    parser.add_argument("--number", type=int, default=1, help="of the log; even: Willow Garage, odd: a maze")
    options = parser.parse_args()
    log, truth = simulated_log(options.number, options.length)
    true = truth[log.scan_readings]
    moved = between(true[:-1], true[1:])
    kilometre = (np.concatenate([[0.0], np.cumsum(np.hypot(moved[:, 0], moved[:, 1]))]) // 1000.0).astype(int)
    mapper, expected, each = Mapper(log.angles, log.max_range, log.mount), between(true[0], true), list[float]()
    print(f"{log.name}: {len(true):,} scans\n{'km':<4}{'ms a scan':>11}{'nodes':>8}{'loops':>8}{'off by':>10}")
    for km in range(int(kilometre[-1]) + 1):
        scans, began, off = np.flatnonzero(kilometre == km), time.process_time(), []
        for k in scans.tolist():
            at = int(log.scan_readings[k])
            pose = mapper.add(float(log.times[at]), log.odometry[at], log.ranges[k])
            if k == 0:
                first = pose
            off.append(np.hypot(*(between(first, pose) - expected[k])[:2]))
        each.append((time.process_time() - began) / len(scans))
        nodes, loops = mapper.back.nodes.count, len(mapper.back.loops)
        print(f"{km + 1:<4}{1e3 * each[-1]:>11.2f}{nodes:>8,}{loops:>8,}{np.mean(off):>8.3f} m", flush=True)
    began = time.process_time()
    result = mapper.finish()
    finished, outcome = time.process_time() - began, compare(result.poses, true)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    if len(each) > 3:  # the last kilometre may be cut short, and is left out then
        whole = each[:-1] if np.sum(kilometre == kilometre[-1]) < 0.5 * np.sum(kilometre == 0) else each
        print(f"time a scan, last kilometre over the third: {whole[-1] / whole[2]:.2f}")
    print(f"finishing {finished:.0f} s; end off by {outcome.end:.3f} m, worst {outcome.worst:.3f} m; {memory:,.0f} MiB")
    print("\n".join(result.doubts))


if __name__ == "__main__":
    main()
