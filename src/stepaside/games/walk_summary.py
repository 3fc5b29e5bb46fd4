"""The figures of a walk."""

from math import degrees
from typing import Any

import numpy as np

from ..poses import Array
from .walk import WalkRun

WARM_UP = 3.0  # left out of the figures, in [s]


def summarise_walk(result: WalkRun) -> dict[str, Any]:
    """Figures of a walk after its first three seconds, ready for JSON.

    Errors are in the frame of the support foot; speed and yaw are compared
    over whole gait cycles with what the plans asked for.
    """
    settings = result.settings
    arrays = result.arrays
    steady = arrays["time"] >= WARM_UP
    a = {name: values[steady] for name, values in arrays.items()}
    return {
        "outcome": result.outcome.value,
        "message": result.message,
        "seed": settings.seed,
        "duration_s": round(result.duration, 9),
        "steps": result.steps,
        "adapted_steps": result.adapted,
        "method": settings.control.method,
        "feedback": settings.control.feedback,
        "push_impulse_n_s": list(result.push_impulse),
        **_progress(a, 2.0 * settings.gait.step_duration),
        "slip_per_step_m": _slip(a),
        "tracking": {
            "com_x_m": _error(a["com_x"], a["reference_x"]),
            "com_y_m": _error(a["com_y"], a["reference_y"]),
            "zmp_x_m": _error(a["zmp_x"], a["zmp_reference_x"]),
            "zmp_y_m": _error(a["zmp_y"], a["zmp_reference_y"]),
        },
        "estimation": {
            f"{name}_{unit}": _error(a[f"estimated_{name}"], a[name])
            for name, unit in (
                ("com_x", "m"),
                ("com_y", "m"),
                ("velocity_x", "m_s"),
                ("velocity_y", "m_s"),
                ("zmp_x", "m"),
                ("zmp_y", "m"),
                ("roll", "rad"),
                ("pitch", "rad"),
            )
        },
        "tilt_max_deg": _tilt(a),
        "min_zmp_margin_m": result.zmp_margin,
        "qp": _solver(result),
        "real_time_factor": result.duration / max(result.wall_time, 1e-9),
    }


def _solver(result: WalkRun) -> dict[str, Any] | None:
    """Figures of the MPC's solver; None without one."""
    answers = result.answers
    if not answers:
        return None
    times = 1e6 * np.array([a.time for a in answers])
    return {
        "solves": len(answers),
        "infeasible": sum(not a.feasible for a in answers),
        "median_us": float(np.median(times)),
        "p99_us": float(np.quantile(times, 0.99)),
        "iterations": float(np.mean([a.iterations for a in answers])),
        "greatest_excess_m": max(float(np.hypot(*a.excess)) for a in answers),
    }


def _progress(a: dict[str, Array], cycle: float) -> dict[str, Any]:
    """Speed and rate of turn, true and asked for."""
    time = a["time"]
    if len(time) < 3 or time[-1] - time[0] < 2.0 * cycle:
        return {"speed_m_s": None, "speed_ratio": None, "yaw_ratio": None}
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
    return {
        "speed_m_s": true / lasted,
        "speed_ratio": true / asked if asked > 0.01 else None,
        "yaw_rate_deg_s": degrees(float(turned[-1] - turned[0])) / lasted,
        "yaw_ratio": (
            float(turned[-1] - turned[0]) / yaw if abs(yaw) > 0.05 else None
        ),
    }


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


def _error(value: Array, wanted: Array) -> dict[str, float] | None:
    off = value - wanted
    off = off[np.isfinite(off)]
    if off.size == 0:
        return None
    return {
        "rms": float(np.sqrt(np.mean(off**2))),
        "mean": float(np.mean(off)),
        "max": float(np.abs(off).max()),
    }


def _tilt(a: dict[str, Array]) -> float | None:
    if a["roll"].size == 0:
        return None
    return degrees(float(np.hypot(a["roll"], a["pitch"]).max()))
