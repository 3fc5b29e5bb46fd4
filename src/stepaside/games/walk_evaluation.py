"""Evaluation of a recorded walk, in the frame of the support foot.

Odometry drifts from the world by slip.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.poses import Array
from .players import Player, RobotPlayer
from .run import Run
from .summary import SolverSummary, WalkingSummary
from .trajectory import OF_EVENTS, Trajectory

if TYPE_CHECKING:
    from ..locomotion.zmp.mpc import MpcResult

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


def summarise_walk(
    run: Run, walker: Player, solved: "Sequence[MpcResult]"
) -> WalkingSummary:
    """Compute the summary of a walk; with the results of its MPC, if any."""
    assert isinstance(walker, RobotPlayer)
    pusher, solver = walker.robot.pusher, None
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
    return replace(
        walking,
        adapted_steps=walker.scheme.walk.balance.adapted,
        push_impulse_n_s=pusher.impulse if pusher else (0.0, 0.0),
        solver=solver,
    )


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
