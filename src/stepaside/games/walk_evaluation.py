"""Summary of a finished walk."""

from collections.abc import Mapping, Sequence
from math import degrees
from typing import Any, NamedTuple

import numpy as np

from ..core.poses import Array
from ..locomotion.zmp.mpc import MpcResult
from .game import GameInPlay
from .robot_player import RobotPlayer
from .support_foot_columns import express_in_support_foot, upright_samples
from .trajectory import PlanningTimes, Trajectory
from .walk_settings import WALKER, WalkSettings
from .walk_summary import (
    ErrorStatistics,
    EstimationErrors,
    SolverSummary,
    TrackingErrors,
    WalkSummary,
)

WARM_UP = 3.0  # left out of the evaluation, in [s]
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
    """Speed and yaw rate of a walk; None where too short to measure.

    Attributes:
        speed: Speed, in [m/s].
        way: Path length over its reference.
        yaw_rate: Yaw rate, in [deg/s].
        turn: Turn over its reference.
    """

    speed: float | None = None
    way: float | None = None
    yaw_rate: float | None = None
    turn: float | None = None


def summarise_walk(
    settings: WalkSettings,
    game: GameInPlay,
    times: Array,
    tracks: Mapping[str, Trajectory],
    planning: Mapping[str, PlanningTimes],
    walker: RobotPlayer,
    solved: Sequence[MpcResult],
) -> WalkSummary:
    """Compute the summary of a walk.

    Args:
        settings: Settings of the walk.
        game: The game that was played.
        times: Times of the samples, in [s]. Shape (n,).
        tracks: Trajectory with foot states and estimates.
        planning: Planning times of the robot.
        walker: The robot.
        solved: Results of the solver of the MPC, if there is one.
    """
    mask = upright_samples(times, game.outcome)
    in_foot = express_in_support_foot(times, tracks[WALKER])
    columns = {name: values[mask] for name, values in in_foot.items()}
    own, pusher = planning[WALKER], walker.robot.pusher
    return WalkSummary(
        seed=settings.seed,
        steps=own.steps,
        adapted_steps=walker.scheme.walk.balance.adapted,
        method=str(settings.control.method),
        feedback=bool(settings.control.feedback),
        push_impulse_n_s=(0.0, 0.0) if pusher is None else pusher.impulse,
        min_zmp_margin_m=own.zmp_margin,
        qp=_solver(solved),
        real_time_factor=game.real_time_factor,
        **measured(columns, 2.0 * settings.gait.step_duration),
    )


def measured(columns: dict[str, Array], cycle: float) -> dict[str, Any]:
    """Return the values of a summary that columns of a walk give.

    Args:
        columns: Evenly spaced samples; see
            :func:`.express_in_support_foot`.
        cycle: Duration of a gait cycle, in [s].
    """
    steady = columns["time"] >= WARM_UP
    a = {name: values[steady] for name, values in columns.items()}
    pace = _pace(a, cycle)
    return {
        "speed_m_s": pace.speed,
        "speed_ratio": pace.way,
        "yaw_rate_deg_s": pace.yaw_rate,
        "yaw_ratio": pace.turn,
        "slip_per_step_m": _slip(a),
        "tracking": TrackingErrors(
            com_x_m=_error(a["com_x"], a["com_reference_x"]),
            com_y_m=_error(a["com_y"], a["com_reference_y"]),
            zmp_x_m=_error(a["zmp_x"], a["zmp_reference_x"]),
            zmp_y_m=_error(a["zmp_y"], a["zmp_reference_y"]),
        ),
        "estimation": EstimationErrors(
            **{
                f"{name}_{unit}": _error(a[f"estimated_{name}"], a[name])
                for name, unit in ESTIMATED.items()
            }
        ),
        "tilt_max_deg": _tilt(a),
    }


def _solver(answers: Sequence[MpcResult]) -> SolverSummary | None:
    """Summarise the solver of the MPC; None without one."""
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
    """Compute speed and yaw rate over whole gait cycles."""
    time = a["time"]
    if len(time) < 3 or time[-1] - time[0] < 2.0 * cycle:
        return WalkingPace()
    samples_per_cycle = round(cycle / float(time[1] - time[0]))
    cycles = (len(time) - 1) // samples_per_cycle
    rows = np.arange(cycles + 1) * samples_per_cycle
    elapsed = float(time[rows[-1]] - time[rows[0]])

    def length(x: Array, y: Array) -> float:
        return float(np.hypot(np.diff(x[rows]), np.diff(y[rows])).sum())

    true_length = length(a["com_in_world_x"], a["com_in_world_y"])
    planned_length = length(
        a["com_reference_in_world_x"], a["com_reference_in_world_y"]
    )
    heading = np.unwrap(a["heading"])[rows]
    planned_heading = np.unwrap(a["heading_reference"])[rows]
    true_turn = float(heading[-1] - heading[0])
    planned_turn = float(planned_heading[-1] - planned_heading[0])
    return WalkingPace(
        true_length / elapsed,
        true_length / planned_length if planned_length > 0.01 else None,
        degrees(true_turn) / elapsed,
        true_turn / planned_turn if abs(planned_turn) > 0.05 else None,
    )


def _slip(a: dict[str, Array]) -> float | None:
    """Return the mean slip of the support foot in single support, in [m]."""
    single = a["single"] > 0.5
    edges = np.flatnonzero(np.diff(single.astype(int)))
    slips = [
        float(
            np.hypot(
                a["foot_in_world_x"][end - 1]
                - a["foot_in_world_x"][start + 2],
                a["foot_in_world_y"][end - 1]
                - a["foot_in_world_y"][start + 2],
            )
        )
        for start, end in zip(edges[:-1], edges[1:], strict=True)
        if single[start + 1] and end - start > 6
    ]
    return float(np.mean(slips)) if slips else None


def _error(values: Array, references: Array) -> ErrorStatistics | None:
    errors = values - references
    errors = errors[np.isfinite(errors)]
    if errors.size == 0:
        return None
    return ErrorStatistics(
        rms=float(np.sqrt(np.mean(errors**2))),
        mean=float(np.mean(errors)),
        max=float(np.abs(errors).max()),
    )


def _tilt(a: dict[str, Array]) -> float | None:
    if a["roll"].size == 0:
        return None
    return degrees(float(np.hypot(a["roll"], a["pitch"]).max()))
