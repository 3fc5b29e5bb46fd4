"""Walks of one robot."""

from collections.abc import Mapping
from typing import Any

from .markdown import number, table

ERRORS = (
    ("CoM x, y [mm]", ("com_x_m", "com_y_m"), 1e3, 1),
    ("CoM velocity x, y [m/s]", ("velocity_x_m_s", "velocity_y_m_s"), 1.0, 3),
    ("roll, pitch [rad]", ("roll_rad", "pitch_rad"), 1.0, 3),
)
VARIANTS = {
    "hardware": "hardware",
    "no-play": "without play",
    "no-delay": "without delay",
    "ideal-torque": "with ideal torque",
    "no-noise": "without noise of the sensors",
    "exact-masses": "with exact masses",
    "corrected": "hardware, with the correction",
}


def rms(result: Mapping[str, Any]) -> str:
    """List the mean over seeds of the rms error of each estimate, by body."""
    bodies = result["bodies"]
    return table(
        ("", *bodies),
        [
            (
                words,
                *(
                    ", ".join(
                        number(scale * body["estimation"][key]["mean"], digits)
                        for key in keys
                    )
                    for body in bodies.values()
                ),
            )
            for words, keys, scale, digits in ERRORS
        ],
    )


def pace(result: Mapping[str, Any]) -> str:
    """List speed, turning and slip of each variant, and the largest effect."""
    found = result["variants"]
    speed = {name: v["speed_ratio"]["mean"] for name, v in found.items()}
    taken = sorted(set(speed) - {"hardware", "corrected"})
    most = max(taken, key=lambda name: speed[name])
    rows = [
        (
            VARIANTS[name],
            number(variant["speed_ratio"]["mean"], 2),
            number(variant["yaw_ratio"]["mean"], 2),
            number(1e3 * variant["slip_per_step_m"]["mean"], 1),
        )
        for name, variant in found.items()
    ]
    head = ("body", "speed / planned", "turning / planned", "slip a step [mm]")
    return (
        f"{table(head, rows)}\n\nMost is gained {VARIANTS[most]}: speed "
        f"{number(speed[most], 2)} of the plan, not "
        f"{number(speed['hardware'], 2)}."
    )


def long_walks(result: Mapping[str, Any]) -> str:
    """List outcomes and speeds of long walks."""
    return table(
        ("walk", "outcome", "steps", "speed / planned", "turning / planned"),
        [
            (
                words,
                f"{found['outcome']}, {found['duration_s'] / 60.0:.1f} min",
                str(found["steps"]),
                number(found["speed_ratio"]),
                number(found["yaw_ratio"]),
            )
            for words, found in result["walks"].items()
        ],
    )


def fast_walks(result: Mapping[str, Any]) -> str:
    """List falls, speed and turning with the fast gait, by body."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    straight: dict[str, list[float]] = {}
    for name, found in result["walks"].items():
        body, way, bearing, _ = name.split("/")
        groups.setdefault(f"{body}, {way}", []).append(found)
        if bearing == "0" and found["speed_m_s"] is not None:
            straight.setdefault(f"{body}, {way}", []).append(
                found["speed_m_s"]
            )

    def spread(values: list[float]) -> str:
        ends = {number(value, 3) for value in (min(values), max(values))}
        return "-".join(sorted(ends))

    def ratios(found: list[Mapping[str, Any]], key: str) -> str:
        return spread([row[key] for row in found if row[key] is not None])

    return table(
        (
            "walks of the fast gait",
            "number",
            "falls",
            "speed, straight on [m/s]",
            "speed / planned",
            "turning / planned",
        ),
        [
            (
                words,
                str(len(found)),
                str(sum(row["outcome"] != "completed" for row in found)),
                spread(straight[words]),
                ratios(found, "speed_ratio"),
                ratios(found, "yaw_ratio"),
            )
            for words, found in groups.items()
        ],
    )
