"""The figures of a walk."""

from math import degrees
from typing import NamedTuple

import numpy as np

from ..core.poses import Array
from ..locomotion.zmp.mpc import MpcResult
from .outcome import Outcome
from .support_foot_view import COLUMNS, on_its_feet, seen_from_foot
from .trajectory import Trajectory
from .walk_settings import WalkSettings
from .walk_summary import (
    ErrorStatistics,
    EstimationErrors,
    SolverSummary,
    TrackingErrors,
    WalkSummary,
)

WARM_UP = 3.0  # left out of the figures, in [s]
ESTIMATED = {
    "com_x": "m",
    "com_y": "m",
    "velocity_x": "m_s",
    "velocity_y": "m_s",
    "zmp_x": "m",
    "zmp_y": "m",
    "roll": "rad",
    "pitch": "rad",
}


class WalkingPace(NamedTuple):
    """How fast a robot walked and turned; None where nothing tells.

    Attributes:
        speed: In [m/s].
        way: Way walked over the way that was asked for.
        yaw_rate: In [deg/s].
        turn: Turn over the turn that was asked for.
    """

    speed: float | None = None
    way: float | None = None
    yaw_rate: float | None = None
    turn: float | None = None


class StepCounts(NamedTuple):
    """What a record has no samples of.

    Attributes:
        steps: Footsteps begun.
        adapted: Footsteps that feedback moved.
        impulse: Of all pushes, in the world (x, y), in [N s].
        zmp_margin: Least ZMP margin of the plans walked, in [m].
        answers: Of the solver of the MPC, if there is one.
        wall_time: Time that the walk took, in [s].
    """

    steps: int
    adapted: int
    impulse: tuple[float, float]
    zmp_margin: float | None
    answers: tuple[MpcResult, ...]
    wall_time: float


def summarise_walk(
    settings: WalkSettings,
    outcome: Outcome,
    message: str,
    duration: float,
    times: Array,
    track: Trajectory,
    counted: StepCounts,
) -> WalkSummary:
    """Figures of a walk that is over.

    Args:
        settings: What decided it.
        outcome: How it ended.
        message: What ended it, in words.
        duration: Simulated time, in [s].
        times: Of the samples, in [s]. Shape (n,).
        track: Record of who walked, looked at closely; without samples, if
            none was kept.
        counted: What the record has no samples of.
    """
    columns = {name: np.zeros(0) for name in COLUMNS}
    if len(times):
        even = on_its_feet(times, outcome)
        seen = seen_from_foot(times, track)
        columns = {name: values[even] for name, values in seen.items()}
    return figures_of(settings, outcome, message, duration, columns, counted)


def figures_of(
    settings: WalkSettings,
    outcome: Outcome,
    message: str,
    duration: float,
    columns: dict[str, Array],
    counted: StepCounts,
) -> WalkSummary:
    """Figures of a walk that was seen from its feet.

    Args:
        settings: What decided it.
        outcome: How it ended.
        message: What ended it, in words.
        duration: Simulated time, in [s].
        columns: Evenly spaced samples, by the names of ``COLUMNS``.
        counted: What they do not tell.
    """
    steady = columns["time"] >= WARM_UP
    a = {name: values[steady] for name, values in columns.items()}
    pace = _pace(a, 2.0 * settings.gait.step_duration)
    return WalkSummary(
        outcome=outcome.value,
        message=message,
        seed=settings.seed,
        duration_s=round(duration, 9),
        steps=counted.steps,
        adapted_steps=counted.adapted,
        method=settings.control.method,
        feedback=settings.control.feedback,
        push_impulse_n_s=counted.impulse,
        speed_m_s=pace.speed,
        speed_ratio=pace.way,
        yaw_rate_deg_s=pace.yaw_rate,
        yaw_ratio=pace.turn,
        slip_per_step_m=_slip(a),
        tracking=TrackingErrors(
            com_x_m=_error(a["com_x"], a["reference_x"]),
            com_y_m=_error(a["com_y"], a["reference_y"]),
            zmp_x_m=_error(a["zmp_x"], a["zmp_reference_x"]),
            zmp_y_m=_error(a["zmp_y"], a["zmp_reference_y"]),
        ),
        estimation=EstimationErrors(
            **{
                f"{name}_{unit}": _error(a[f"estimated_{name}"], a[name])
                for name, unit in ESTIMATED.items()
            }
        ),
        tilt_max_deg=_tilt(a),
        min_zmp_margin_m=counted.zmp_margin,
        qp=_solver(counted.answers),
        real_time_factor=duration / max(counted.wall_time, 1e-9),
    )


def _solver(answers: tuple[MpcResult, ...]) -> SolverSummary | None:
    """Figures of the MPC's solver; None without one."""
    if not answers:
        return None
    times = 1e6 * np.array([a.time for a in answers])
    return SolverSummary(
        solves=len(answers),
        infeasible=sum(not a.feasible for a in answers),
        median_us=float(np.median(times)),
        p99_us=float(np.quantile(times, 0.99)),
        iterations=float(np.mean([a.iterations for a in answers])),
        greatest_excess_m=max(float(np.hypot(*a.excess)) for a in answers),
    )


def _pace(a: dict[str, Array], cycle: float) -> WalkingPace:
    """Speed and rate of turn, true and asked for."""
    time = a["time"]
    if len(time) < 3 or time[-1] - time[0] < 2.0 * cycle:
        return WalkingPace()
    stride = round(cycle / float(time[1] - time[0]))
    turns = (len(time) - 1) // stride
    rows = np.arange(turns + 1) * stride
    lasted = float(time[rows[-1]] - time[rows[0]])

    def length(x: Array, y: Array) -> float:
        return float(np.hypot(np.diff(x[rows]), np.diff(y[rows])).sum())

    true, asked = (
        length(a["world_x"], a["world_y"]),
        length(a["asked_x"], a["asked_y"]),
    )
    turned = np.unwrap(a["heading"])[rows]
    wanted = np.unwrap(a["asked_heading"])[rows]
    yaw = float(wanted[-1] - wanted[0])
    gone = float(turned[-1] - turned[0])
    return WalkingPace(
        true / lasted,
        true / asked if asked > 0.01 else None,
        degrees(gone) / lasted,
        gone / yaw if abs(yaw) > 0.05 else None,
    )


def _slip(a: dict[str, Array]) -> float | None:
    """Mean way of the support foot in a single support, in [m]."""
    single = a["single"] > 0.5
    edges = np.flatnonzero(np.diff(single.astype(int)))
    slips = [
        float(
            np.hypot(
                a["foot_x"][end - 1] - a["foot_x"][start + 2],
                a["foot_y"][end - 1] - a["foot_y"][start + 2],
            )
        )
        for start, end in zip(edges[:-1], edges[1:], strict=True)
        if single[start + 1] and end - start > 6
    ]
    return float(np.mean(slips)) if slips else None


def _error(value: Array, wanted: Array) -> ErrorStatistics | None:
    off = value - wanted
    off = off[np.isfinite(off)]
    if off.size == 0:
        return None
    return ErrorStatistics(
        rms=float(np.sqrt(np.mean(off**2))),
        mean=float(np.mean(off)),
        max=float(np.abs(off).max()),
    )


def _tilt(a: dict[str, Array]) -> float | None:
    if a["roll"].size == 0:
        return None
    return degrees(float(np.hypot(a["roll"], a["pitch"]).max()))
