"""Times of planner, MPC, control tick and duel."""

from collections.abc import Mapping
from typing import Any

from .markdown import table

ROWS = {
    "replan_5_steps_us": ("replan of 5 steps", "us", "<= 50"),
    "plan_20_steps_us": ("plan of 20 steps", "us", ""),
    "plan_20_steps_with_samples_us": (
        "plan of 20 steps with feet, ZMP, DCM and CoM every 10 ms",
        "us",
        "<= 100",
    ),
    "drake_zmp_planner_us": ("Drake's ZmpPlanner on the same ZMP", "us", ""),
    "drake_with_samples_us": (
        "the same, with CoM and its velocity every 10 ms",
        "us",
        "",
    ),
    "drake_over_plan": (
        "Drake's plan over our plan of 20 steps",
        "times",
        ">= 10",
    ),
    "drake_over_plan_with_samples": (
        "Drake's plan with samples over ours with samples",
        "times",
        "",
    ),
    "com_difference_to_drake_m": (
        "greatest difference of the two CoM trajectories",
        "m",
        "<= 1e-6",
    ),
    "mpc_tick_us": (
        "tick of the MPC, horizon of two steps, no constraint active",
        "us",
        "<= 1000",
    ),
    "mpc_tick_pushed_us": ("the same, after a push", "us", "<= 1000"),
    "mpc_closed_form_us": ("closed form beside it: a replan", "us", ""),
    "control_tick_us": ("control tick of one robot", "us", "<= 150"),
    "real_time_factor": ("whole duel", "x real time", ">= 8"),
    "bare_physics_real_time_factor": (
        "bare mj_step, same model and motion",
        "x real time",
        "",
    ),
    "duel_over_bare_physics": (
        "cost of the duel over bare mj_step",
        "times",
        "<= 1.7",
    ),
    "physics_over_bare_physics": (
        "physics of the duel over bare mj_step",
        "times",
        "",
    ),
    "hardware_real_time_factor": (
        "whole duel, hardware body with feedback",
        "x real time",
        "",
    ),
    "camera_duel_real_time_factor": (
        "whole duel with cameras",
        "x real time",
        "",
    ),
}


def all_rows(result: Mapping[str, Any]) -> str:
    """Return every time with its limit; missing ones are omitted."""
    figures = result["figures"]
    return table(
        ("what", "measured", "unit", "limit"),
        [
            (what, f"{figures[key]:.3g}", unit, _limit(asked, figures[key]))
            for key, (what, unit, asked) in ROWS.items()
            if key in figures
        ],
    )


def _limit(asked: str, value: float) -> str:
    """Return a limit, and whether a value misses it."""
    if not asked:
        return ""
    sign, limit = asked.split()
    met = value <= float(limit) if sign == "<=" else value >= float(limit)
    return asked if met else f"{asked}: missed"
