"""Run every benchmark in one process and write docs/benchmark.md."""

import json
import platform
from pathlib import Path

from duel import measure_duel
from mpc import measure_mpc
from planner import measure_planner

ROOT = Path(__file__).parent.parent
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
        "<= 2.5",
    ),
}


def main() -> None:
    """Measure, print and write."""
    figures = measure_planner() | measure_mpc() | measure_duel()
    for suffix in ("", "_with_samples"):
        drake = "drake_zmp_planner_us" if not suffix else f"drake{suffix}_us"
        if drake in figures:
            ours = figures[f"plan_20_steps{suffix}_us"]
            figures[f"drake_over_plan{suffix}"] = figures[drake] / ours
    lines = [
        "# Benchmark",
        "",
        "Written by `make bench`, which runs both sides of every ratio in "
        "one process on one core; processor times.",
        f"Python {platform.python_version()}, {platform.machine()}.",
        "",
        "| what | measured | unit | asked |",
        "|---|---|---|---|",
    ]
    for key, (what, unit, asked) in ROWS.items():
        if key in figures:
            lines.append(f"| {what} | {figures[key]:.3g} | {unit} | {asked} |")
    text = "\n".join(lines) + "\n"
    (ROOT / "docs" / "benchmark.md").write_text(text, encoding="utf-8")
    (ROOT / "docs" / "benchmark.json").write_text(
        json.dumps(figures, indent=2) + "\n", encoding="utf-8"
    )
    print(text)


if __name__ == "__main__":
    main()
