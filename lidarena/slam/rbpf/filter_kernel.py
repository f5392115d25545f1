"""The particle filter's kernel: prediction, update, selective resampling and the published map, world by world."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf, merged
from lidarena.base.random_streams import normal, uniform
from lidarena.slam.occupancy import OccupancyMaps, trace_scan
from lidarena.slam.rbpf.copying import copy_matrix, copy_vector
from lidarena.slam.rbpf.likelihood_field import clear_fields, copy_field, field_of
from lidarena.slam.rbpf.particle_filter_state import FilterParameters, FilterState, Scratch
from lidarena.slam.rbpf.point_blocks import BLOCK, PointBlocks, Workspace
from lidarena.slam.rbpf.registration import register_points
from lidarena.slam.rbpf.scan_matching import match, match_cost
from lidarena.slam.rbpf.scan_points import extract_points
from lidarena.slam.rbpf.symmetric import Symmetric, inverse, load, rotated
from lidarena.slam.readings import Reading, ScanGeometry
from lidarena.slam.scan_outline import Outlines
from lidarena.slam.uncertainty import compound_covariance, d_optimality, pose_moments, score_entropy, weight_entropy
from lidarena.world.odometry import deviations, move, relative_motion

_TURN = 0.03
"""Between two of the turned odometries that are tried [rad]."""
# plain numbers as arguments would be types of their own, each compiled apart
_ENTER, _TAKE_BACK, _FIRST = np.int64(1), np.int64(-1), np.int64(0)
_LEAST_VARIANCE = 1e-8
"""Added to the odometry's covariance (m², rad²), so that a robot at rest has an invertible prior."""


@merged
def step_filter(
    w: int,
    reading: Reading,
    geometry: ScanGeometry,
    parameters: FilterParameters,
    stream: NDArray[np.uint64],
    state: FilterState,
    maps: OccupancyMaps,
    scratch: Scratch,
    s: int,
) -> None:
    """Advance world w's filter by one odometry reading and, where due, one scan.

    A filter that has processed no scan yet starts with this one.

    Args:
        w: World.
        reading: What was measured since the last call.
        geometry: Of scans and grids.
        parameters: The filters' settings.
        stream: (4,) random stream.
        state: The filters.
        maps: The published maps.
        scratch: Room to work in.
        s: Which row of it; no other thread may use it meanwhile.
    """
    due = state.updates[w] == 0
    if not due:
        predict(w, reading.duration, reading.motion, parameters, stream, state)
        due = state.since[w, 0] >= parameters.linear_update or state.since[w, 1] >= parameters.angular_update
    if reading.fresh and (due or state.since[w, 2] > parameters.temporal_update):
        update(w, geometry, parameters, reading.scan, stream, s, state, maps, scratch)
    _summarise(w, state)


@leaf
def predict(
    w: int,
    duration: float,
    reading: NDArray[np.float64],
    parameters: FilterParameters,
    stream: NDArray[np.uint64],
    state: FilterState,
) -> None:
    """Move world w's particles by an odometry reading (3,) with sampled noise, and add up motion and covariance."""
    dx, dy, dtheta = reading
    sx, sy, st = deviations(parameters.noise, dx, dy, dtheta)
    for i in range(parameters.particles):
        move(state.particles[w, i], dx + sx * normal(stream), dy + sy * normal(stream), dtheta + st * normal(stream))
    compound_covariance(state.motion[w], state.motion_covariance[w], dx, dy, sx * sx, sy * sy, st * st)
    move(state.motion[w], dx, dy, dtheta)
    state.since[w, 0] += math.hypot(dx, dy)
    state.since[w, 1] += abs(dtheta)
    state.since[w, 2] += duration


@merged
def update(
    w: int,
    geometry: ScanGeometry,
    parameters: FilterParameters,
    scan: NDArray[np.float32],
    stream: NDArray[np.uint64],
    s: int,
    state: FilterState,
    maps: OccupancyMaps,
    scratch: Scratch,
) -> None:
    """Match, weigh, draw and register a scan (beams,) in every particle of world w; publish; resample at low N_eff.

    The first scan of all is registered whole, and the same in every particle. (It takes this way too, and not one of
    its own, since every call below takes seconds to compile.)
    """
    begins = state.updates[w] == 0
    # neighbours lie within each other's stamp: take turns
    stride = np.int64(1) if begins else np.int64(parameters.stride)
    motion, prior = scratch.poses[s, 0], scratch.poses[s, 1]
    count = extract_points(
        scan, geometry.directions, geometry.max_range, parameters.points, state.updates[w] % stride, stride,
        scratch.means[s], scratch.numbers[s], scratch.points[s], scratch.flat[s],
    )  # fmt: skip
    points = PointBlocks(scratch.points[s], count)
    chosen = PointBlocks(scratch.chosen[s], _choose(s, count, parameters.matcher.points, scratch))
    work = Workspace(scratch.work.reals[s], scratch.work.integers[s])
    local = inverse(load(state.motion_covariance[w], _LEAST_VARIANCE))
    if begins:
        clear_fields(state.fields, w)
    else:
        _likeliest_motion(w, geometry.resolution, parameters, chosen, state, maps, scratch, s)
    for i in range(parameters.particles):
        if begins:
            state.ancestors[w, i] = i
            state.log_weights[w, i] = state.scores[w, i] = 0.0
        else:
            copy_vector(prior, state.anchors[w, i])
            information = rotated(local, prior[2])
            copy_vector(state.particles[w, i], prior)
            move(state.particles[w, i], motion[0], motion[1], motion[2])
            move(prior, state.motion[w, 0], state.motion[w, 1], state.motion[w, 2])
            field = field_of(state.fields, w, i, maps.origin[w], geometry.resolution)
            likelihood, posterior = match(
                field, chosen, work, parameters.matcher, prior, information, state.particles[w, i]
            )
            motion[0], motion[1], motion[2] = relative_motion(state.anchors[w, i], state.particles[w, i])
            state.log_weights[w, i] += parameters.likelihood_gain * likelihood
            state.scores[w, i] += likelihood
            _draw(state.particles[w, i], posterior, stream)
        if begins and i > 0:
            copy_field(state.fields, w, _FIRST, i)
        else:
            register_points(
                state.fields, w, i, state.particles[w, i], maps.origin[w], geometry.resolution, points, work
            )
        copy_vector(state.anchors[w, i], state.particles[w, i])
    _normalise(w, state)
    _publish(w, geometry, parameters, scan, state, maps, scratch.outlines, s)
    if state.criteria[w, 2] < parameters.resample_share * parameters.particles:
        _resample(w, stream, scratch.numbers[s], state)
    _forget_motion(w, state)


@leaf
def _likeliest_motion(
    w: int,
    resolution: float,
    parameters: FilterParameters,
    points: PointBlocks,
    state: FilterState,
    maps: OccupancyMaps,
    scratch: Scratch,
    s: int,
) -> None:
    """Which of some particles' sampled motions since the last scan fits the first particle's map best.

    It is written to ``scratch.poses[s, 0]``; ``points`` are fitted.

    What the odometry got wrong is the same for all particles: matching starts each of them where the one before it
    ended, and the first one at the best of several samples. Two steps of Gauss-Newton are then enough where four were
    needed. Beside the samples, the odometry itself is tried with some turn more and less.
    """
    motion, pose = scratch.poses[s, 0], scratch.poses[s, 1]
    work = Workspace(scratch.work.reals[s], scratch.work.integers[s])
    field = field_of(state.fields, w, 0, maps.origin[w], resolution)
    least, samples = math.inf, min(parameters.starts, state.particles.shape[1])
    for i in range(samples + 2 * parameters.turned_starts):
        if i < samples:
            dx, dy, dtheta = relative_motion(state.anchors[w, i], state.particles[w, i])
        else:
            k = i - samples
            dx, dy, dtheta = state.motion[w, 0], state.motion[w, 1], state.motion[w, 2]
            dtheta += _TURN * (k // 2 + 1) * (1.0 if k % 2 == 0 else -1.0)
        copy_vector(pose, state.anchors[w, 0])
        move(pose, dx, dy, dtheta)
        missed = match_cost(field, points, work, pose)
        if missed < least:
            least = missed
            motion[0], motion[1], motion[2] = dx, dy, dtheta


@leaf
def _choose(s: int, count: int, wanted: int, scratch: Scratch) -> int:
    """Copy ``wanted`` points with a normal to ``chosen``, evenly over the scan; returns how many there are."""
    usable, total = scratch.numbers[s], 0
    for i in range(count):
        if scratch.flat[s, i]:
            usable[total] = i
            total += 1
    most: int = min(wanted, total)
    for i in range(most):
        j = usable[i * total // most]
        for k in range(5):
            scratch.chosen[s, i // BLOCK, k, i % BLOCK] = scratch.points[s, j // BLOCK, k, j % BLOCK]
    return most


@leaf
def _draw(pose: NDArray[np.float64], information: Symmetric, stream: NDArray[np.uint64]) -> None:
    """Replace ``pose`` (3,) by a sample of the Gaussian around it, given its information matrix A = L Lᵀ: x + L⁻ᵀ z."""
    xx, xy, xt, yy, yt, tt = information
    l00 = math.sqrt(xx)
    l10, l20 = xy / l00, xt / l00
    l11 = math.sqrt(max(yy - l10 * l10, 1e-12))
    l21 = (yt - l20 * l10) / l11
    l22 = math.sqrt(max(tt - l20 * l20 - l21 * l21, 1e-12))
    z2 = normal(stream) / l22
    z1 = (normal(stream) - l21 * z2) / l11
    z0 = (normal(stream) - l10 * z1 - l20 * z2) / l00
    move(pose, 0.0, 0.0, z2)
    pose[0] += z0
    pose[1] += z1


@leaf
def _normalise(w: int, state: FilterState) -> None:
    """Normalise world w's weights and compute their entropies and N_eff."""
    n = state.log_weights.shape[1]
    top, total = -math.inf, 0.0
    for i in range(n):
        top = max(top, state.log_weights[w, i])
    for i in range(n):
        state.log_weights[w, i] -= top
        state.weights[w, i] = math.exp(state.log_weights[w, i])
        total += state.weights[w, i]
    squares = 0.0
    for i in range(n):
        state.weights[w, i] /= total
        squares += state.weights[w, i] ** 2
    state.criteria[w, 1] = weight_entropy(state.weights[w])
    state.criteria[w, 2] = 1.0 / squares
    state.criteria[w, 3] = score_entropy(state.scores[w])


@leaf
def _publish(
    w: int,
    geometry: ScanGeometry,
    parameters: FilterParameters,
    scan: NDArray[np.float32],
    state: FilterState,
    maps: OccupancyMaps,
    outlines: Outlines,
    s: int,
) -> None:
    """Remember the scan and trace it from the best particle, tracing again the past scans in which that one differs."""
    resolution, directions, max_range = geometry.resolution, geometry.directions, geometry.max_range
    history = parameters.history
    now = state.updates[w]
    slot = now % history
    copy_matrix(state.node_poses[w, slot], state.particles[w])
    copy_vector(state.node_scans[w, slot], scan)
    for i in range(parameters.particles):
        state.node_parents[w, slot, i] = state.ancestors[w, i]
        state.ancestors[w, i] = i
    if parameters.traced:
        best = _best_particle(w, slot, now, parameters, state)
        trace_scan(maps, w, resolution, state.particles[w, best], scan, directions, max_range, _ENTER, outlines, s)
        state.published[w, slot] = best
        parent = np.int64(state.node_parents[w, slot, best])
        past = now - 1
        while past >= 0 and past > now - history and state.published[w, past % history] != parent:
            slot = past % history
            shown, node = state.published[w, slot], state.node_poses[w, slot]
            trace_scan(
                maps,
                w,
                resolution,
                node[shown],
                state.node_scans[w, slot],
                directions,
                max_range,
                _TAKE_BACK,
                outlines,
                s,
            )
            trace_scan(
                maps, w, resolution, node[parent], state.node_scans[w, slot], directions, max_range, _ENTER, outlines, s
            )
            state.published[w, slot] = parent
            parent = np.int64(state.node_parents[w, slot, parent])
            past -= 1
    state.updates[w] = now + 1


@leaf
def _best_particle(w: int, slot: int, now: int, parameters: FilterParameters, state: FilterState) -> int:
    """The likeliest particle, or the published one's likeliest descendant, if not ``hysteresis`` times less likely."""
    best = 0
    for i in range(parameters.particles):
        if state.weights[w, i] > state.weights[w, best]:
            best = i
    if now == 0:
        return best
    shown = state.published[w, (now - 1) % parameters.history]
    descendant = -1
    for i in range(parameters.particles):
        if state.node_parents[w, slot, i] == shown and (
            descendant < 0 or state.weights[w, i] > state.weights[w, descendant]
        ):
            descendant = i
    if descendant >= 0 and state.weights[w, descendant] * parameters.hysteresis >= state.weights[w, best]:
        return descendant
    return best


@leaf
def _resample(w: int, stream: NDArray[np.uint64], copies: NDArray[np.int64], state: FilterState) -> None:
    """Systematic resampling; survivors stay where they are, their copies overwrite the dead.

    ``copies`` (at least N,) is overwritten.
    """
    n = state.weights.shape[1]
    for i in range(n):
        copies[i] = 0
    offset, total, drawn = uniform(stream), 0.0, 0
    for i in range(n):
        total += state.weights[w, i]
        while drawn < n and (i == n - 1 or drawn + offset < total * n):
            copies[i] += 1
            drawn += 1
    dead = 0
    for i in range(n):
        for _ in range(copies[i] - 1):
            while copies[dead] > 0:
                dead += 1
            copy_vector(state.particles[w, dead], state.particles[w, i])
            copy_vector(state.anchors[w, dead], state.anchors[w, i])
            state.ancestors[w, dead] = i
            copy_field(state.fields, w, i, dead)
            dead += 1
    for i in range(n):
        state.log_weights[w, i] = state.scores[w, i] = 0.0
        state.weights[w, i] = 1.0 / n


@leaf
def _summarise(w: int, state: FilterState) -> None:
    """Mean pose, covariance and D-optimality of world w."""
    pose_moments(state.particles[w], state.weights[w], state.estimate[w], state.covariance[w])
    state.criteria[w, 0] = d_optimality(state.covariance[w])


@leaf
def _forget_motion(w: int, state: FilterState) -> None:
    """Begin to add up the odometry anew after a scan."""
    for k in range(3):
        state.motion[w, k] = state.since[w, k] = 0.0
        for j in range(3):
            state.motion_covariance[w, k, j] = 0.0
