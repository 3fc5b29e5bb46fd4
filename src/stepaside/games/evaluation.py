"""Evaluation of a recorded game: its summary.

A walk is evaluated in the frame of the support foot, as odometry drifts from
the world by slip.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from math import degrees, isfinite
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.constants import CAPTURE_DISTANCE
from ..core.poses import Array
from ..sim.person_settings import RADIUS
from ..theory.unicycle.circles import fit_circle
from .game import GameInPlay, Outcome
from .run import Run
from .summary import (
    CrowdSummary,
    PairSummary,
    PlayerSummary,
    SolverSummary,
    Summary,
    WalkingSummary,
)
from .trajectory import (
    OF_EVENTS,
    Trajectory,
    angle_between,
    cycle_mean,
    distance_between,
    last_third,
)

if TYPE_CHECKING:
    from ..locomotion.zmp.mpc import MpcResult

MIN_TURN = 0.5  # of a path to which a circle can be fitted, in [rad]
INTRUSIONS = (0.45, 1.2)  # of crowd navigation: intimate and personal, [m]


def measure(run: Run, late: NDArray[np.bool_] | None = None) -> Summary:
    """Return the part of a summary that trajectories give.

    Args:
        run: The run; its summary is not used.
        late: Samples of means and circles; those of the last third by
            default. Shape (n,).
    """
    late = last_third(run.times) if late is None else late
    pairs = {
        (one, other): _pair(run, one, other, late)
        for one, other in combinations(run.players, 2)
    }
    facing = {frozenset(names) for names in run.opponents}
    closest = [p.closest_m for n, p in pairs.items() if frozenset(n) in facing]
    times = (pair.captured_at_s for pair in pairs.values())
    return Summary(
        distance_m=_mean(run.distance[late]),
        relative_orientation_deg=_mean(run.orientation[late]),
        min_distance_m=min(closest, default=None),
        captured_at_s=min((t for t in times if t is not None), default=None),
        players={name: _player(run, name, late) for name in run.players},
        pairs={" - ".join(names): pair for names, pair in pairs.items()},
    )


def _mean(values: Array) -> float | None:
    mean = float(values.mean()) if len(values) else np.nan
    return mean if isfinite(mean) else None


def _pair(
    run: Run, one: str, other: str, late: NDArray[np.bool_]
) -> PairSummary:
    first, second = run.tracks[one], run.tracks[other]
    apart = distance_between(first.torso, second.torso)
    closest = int(apart.argmin())
    opposed = bool({(one, other), (other, one)} & {*run.facing})
    caught = np.flatnonzero(opposed & (apart <= CAPTURE_DISTANCE))
    last = first.unicycle[late], second.unicycle[late]
    return PairSummary(
        closest_m=float(apart[closest]),
        closest_at_s=float(run.times[closest]),
        captured_at_s=float(run.times[caught[0]]) if len(caught) else None,
        distance_m=_mean(distance_between(*last)),
        angle_deg=_mean(np.degrees(angle_between(*last))),
    )


def _player(run: Run, name: str, late: NDArray[np.bool_]) -> PlayerSummary:
    poses, times, radius = run.tracks[name].unicycle, run.times, None
    path = [poses[:, 0], poses[:, 1]]
    if run.tracks[name].qpos is not None or run.game == "play":
        path = [cycle_mean(way, times, run.settings.cycle) for way in path]
    if late.sum() > 2 and np.ptp(poses[late, 2]) > MIN_TURN:
        radius = fit_circle(poses[late, :2])[1]
    return PlayerSummary(
        path_m=float(np.hypot(*np.diff(path, axis=1)).sum()),
        radius_m=radius if radius is not None and isfinite(radius) else None,
    )


def crowd_of(run: Run, game: GameInPlay, own: Any) -> CrowdSummary | None:
    """Measure the encounter of a robot with people; None without any."""
    people = [p.name for p in run.settings.players if p.body == "person"]
    if run.game != "game" or not own.decides or not people:
        return None
    poses, times = run.tracks[own.name].unicycle, run.times
    apart = np.array(
        [distance_between(poses, run.tracks[p].unicycle) for p in people]
    )
    if run.settings.level == "physics" and own.body == "robot":
        collisions = int(own.name in game.touched)
    else:
        touching = apart < own.radius + RADIUS
        begins = np.diff(touching.astype(int), axis=1, prepend=0) > 0
        collisions = int(np.count_nonzero(begins))
    nearest = apart.min(axis=0)
    period = float(times[1] - times[0]) if len(times) > 1 else 0.0
    intimate, personal = (
        period * int(np.count_nonzero(nearest < limit)) for limit in INTRUSIONS
    )
    completed = run.outcome is Outcome.COMPLETED
    reached = own.name in game.goals_at if own.goal else completed
    harmed = collisions or own.name in (*game.touched, *game.fallen)
    return CrowdSummary(
        people=len(people),
        success=reached and not harmed,
        collisions=collisions,
        intimate_s=intimate,
        personal_s=personal,
    )


WARM_UP = 3.0  # left out of the evaluation, in [s]


def express_in_support_foot(track: Trajectory) -> dict[str, Array]:
    """Express a walk in the frame of the support foot.

    True quantities are in the frame of the true sole, references and
    estimates in that of the planned sole.

    Returns:
        Columns x and y of ``com``, ``zmp`` and ``velocity``, of the
        references ``com_reference`` and ``zmp_reference``, and of the
        estimates, like ``estimated_com``. Shape (n, 2) each.

    Raises:
        KeyError: If the trajectory has no foot states.
    """
    rows = track.arrays()
    sole, planned = rows["sole"], rows["support"][:, 2:]
    estimate = rows.get("estimate", np.full((len(sole), 8), np.nan))
    points = {
        "com": (sole, rows["com"]),
        "zmp": (sole, rows["zmp"]),
        "com_reference": (planned, rows["com_reference"]),
        "zmp_reference": (planned, rows["zmp_reference"]),
        "estimated_com": (planned, estimate[:, :2]),
        "estimated_zmp": (planned, estimate[:, 4:6]),
    }
    return {
        "velocity": _turned(sole, rows["velocity"]),
        "estimated_velocity": _turned(planned, estimate[:, 2:4]),
    } | {
        name: _turned(frames, places[:, :2] - frames[:, :2])
        for name, (frames, places) in points.items()
    }


def _turned(frames: Array, vectors: Array) -> Array:
    """Rotate vectors from the world to frames. Shape (n, 2)."""
    c, s = np.cos(frames[:, 2]), np.sin(frames[:, 2])
    x, y = vectors.T
    return np.column_stack([c * x + s * y, c * y - s * x])


def summarise_walk(run: Run, solved: "Sequence[MpcResult]") -> WalkingSummary:
    """Compute the summary of a walk; with the results of its MPC, if any."""
    solver = None
    if solved:
        spent = 1e6 * np.array([answer.time for answer in solved])
        solver = SolverSummary(
            solves=len(solved),
            infeasible=sum(not answer.feasible for answer in solved),
            median_us=float(np.median(spent)),
            p99_us=float(np.quantile(spent, 0.99)),
        )
    mask = run.times >= WARM_UP
    mask[-1] = False  # it may lie between two periods, or after a fall
    rows: dict[str, Any] = {
        name: rows[mask]
        for name, rows in run.walker.arrays().items()
        if name not in OF_EVENTS
    }
    walking = walking_of(
        run.times[mask], Trajectory(**rows), run.settings.cycle
    )
    return replace(walking, solver=solver)


def walking_of(
    times: Array, track: Trajectory, cycle: float
) -> WalkingSummary:
    """Measure a walk, at evenly spaced samples with foot states.

    A gait cycle has a duration, in [s].
    """
    rows, seen = track.arrays(), express_in_support_foot(track)
    lean = rows["tilt"]
    tilt = np.hypot(*lean.T)
    estimated = rows.get("estimate", np.full((len(times), 8), np.nan))[:, 6:]
    speed, speed_ratio, yaw_rate, yaw_ratio = _pace(times, rows, cycle)
    return WalkingSummary(
        speed_m_s=speed,
        speed_ratio=speed_ratio,
        yaw_rate_deg_s=yaw_rate,
        yaw_ratio=yaw_ratio,
        slip_per_step_m=_slip(rows["support"][:, 1], rows["sole"]),
        tilt_max_deg=degrees(float(tilt.max())) if len(tilt) else None,
        tracking={
            f"{name}_{axis}_m": rms
            for name in ("com", "zmp")
            for axis, rms in _errors(seen[name] - seen[f"{name}_reference"])
        },
        estimation={
            f"{name}_{axis}_{unit}": rms
            for name, unit in (("com", "m"), ("zmp", "m"), ("velocity", "m_s"))
            for axis, rms in _errors(seen[f"estimated_{name}"] - seen[name])
        }
        | {
            f"{name}_rad": rms
            for name, (_, rms) in zip(
                ("roll", "pitch"), _errors(estimated - lean), strict=True
            )
        },
    )


def _errors(errors: Array) -> list[tuple[str, float | None]]:
    """Return the RMS of two columns of errors, without NaN."""
    known = [column[np.isfinite(column)] for column in errors.T]
    return [
        (axis, float(np.sqrt(np.mean(own**2))) if len(own) else None)
        for axis, own in zip("xy", known, strict=True)
    ]


def _pace(
    times: Array, rows: dict[str, Array], cycle: float
) -> list[float | None]:
    """Return speed [m/s] and yaw rate [deg/s], each with its ratio.

    They are over whole gait cycles; None where too short to measure.
    """
    if len(times) < 3 or times[-1] - times[0] < 2.0 * cycle:
        return [None] * 4
    at = slice(None, None, round(cycle / float(times[1] - times[0])))
    elapsed = float(np.ptp(times[at]))
    way, planned_way = (
        float(np.hypot(*np.diff(rows[name][at, :2], axis=0).T).sum())
        for name in ("com", "com_reference")
    )
    turn, planned = (
        float(np.diff(np.unwrap(values)[at]).sum())
        for values in (rows["torso"][:, 2], rows["heading_reference"][:, 0])
    )
    return [
        way / elapsed,
        way / planned_way if planned_way > 0.01 else None,
        degrees(turn) / elapsed,
        turn / planned if abs(planned) > 0.05 else None,
    ]


def _slip(single: Array, soles: Array) -> float | None:
    """Return the mean slip of the support foot in single support, in [m]."""
    edges = np.flatnonzero(np.diff((single > 0.5).astype(int)))
    slips = [
        np.hypot(*(soles[end - 1, :2] - soles[start + 2, :2]))
        for start, end in zip(edges[:-1], edges[1:], strict=True)
        if single[start + 1] > 0.5 and end - start > 6
    ]
    return float(np.mean(slips)) if slips else None
