"""Claims of Sec. III-E and IV, measured on two NAOs in physics."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..planning import PRESETS
from ..poses import Array
from ..simulation.duel import DuelResult, run_duel
from ..simulation.settings import DuelSettings, StartSettings
from ..simulation.summary import summarise
from .claims import Row

LEVEL = "physics"
SLIPPERY = 0.05  # sliding friction of a floor on which the feet slip


def circle_rows(seed: int) -> list[Row]:
    """The circle of Sec. IV."""
    result = run_duel(DuelSettings(seed=seed))
    found = summarise(result)
    theory = found["theory"]
    landings = [
        np.diff(result.arrays[f"{name}_landings"][2:, 0])
        for name in ("pursuer", "evader")
    ]
    gait = result.settings.gait
    late = max(float(np.abs(d - gait.step_duration).max()) for d in landings)
    pursuer, evader = walking_speeds(result)

    def row(
        claim: str, expected: float, measured: float, off: float, unit: str
    ) -> Row:
        return Row(claim, "IV, Fig. 5", LEVEL, expected, measured, off, unit)

    radius = theory["radius_m"]
    return [
        row(
            "the pursuer converges to a circle",
            radius,
            found["pursuer"]["radius_m"],
            0.04 * radius,
            "m",
        ),
        row(
            "the evader converges to a circle",
            radius,
            found["evader"]["radius_m"],
            0.04 * radius,
            "m",
        ),
        row(
            "their distance",
            theory["distance_m"],
            found["distance_m"],
            0.04 * theory["distance_m"],
            "m",
        ),
        row(
            "with a relative orientation of pi/2",
            90.0,
            found["relative_orientation_deg"],
            3.0,
            "deg",
        ),
        row("at the same speed (ratio)", 1.0, evader / pursuer, 0.04, "1"),
        Row(
            "a new plan follows each double support (greatest deviation of "
            "the time between landings from a step)",
            "III-E",
            LEVEL,
            0.0,
            late,
            1e-9,
            "s",
        ),
        Row(
            "replanning does not destabilise (greatest jump of the CoM "
            "velocity reference)",
            "III-E",
            LEVEL,
            0.0,
            found["max_com_velocity_jump_m_s"],
            1e-9,
            "m/s",
            as_printed="(15) alone lets the velocity jump by eta times the "
            "change of x_u",
        ),
    ]


def duration_rows(seed: int) -> list[Row]:
    """The durations as printed, and exchanged."""
    settings = DuelSettings(seed=seed, duration=30.0)
    printed = run_duel(replace(settings, gait=PRESETS["as-printed"]))
    walks = run_duel(settings)
    pursuer, _ = walking_speeds(walks)
    return [
        Row(
            "with single support 0.122 s and double support 0.425 s, and "
            "the joints' speed limits, the robots fall (time of the fall)",
            "IV",
            LEVEL,
            30.0,
            printed.duration,
            0.0,
            "s",
            "<",
            "single and double support of 0.122 s and 0.425 s",
        ),
        Row(
            "exchanged, they walk (time walked)",
            "IV",
            LEVEL,
            30.0,
            walks.duration,
            1e-6,
            "s",
        ),
        Row(
            "at 0.04 m every 0.547 s, slower than the path's 0.1 m/s",
            "IV",
            LEVEL,
            0.04 / 0.547,
            pursuer,
            0.004,
            "m/s",
            as_printed="0.1 m/s",
        ),
    ]


def slip_rows(seed: int) -> list[Row]:
    """The smaller circle of the experiment, where feet slip."""
    start = StartSettings(0.8, 0.2, 0.1)
    settings = DuelSettings(seed=seed, duration=80.0, start=start)
    slippery = replace(settings.physics, friction=SLIPPERY)
    grip = run_duel(settings)
    slip = run_duel(replace(settings, physics=slippery))
    radii = [_mean_radius(summarise(result)) for result in (grip, slip)]
    speeds = [float(np.mean(walking_speeds(r))) for r in (grip, slip)]
    section = "IV, Fig. 6"
    return [
        Row(
            f"on a floor with friction {SLIPPERY} the robots are slower "
            "than on one with 0.8",
            section,
            LEVEL,
            speeds[0],
            speeds[1],
            0.0,
            "m/s",
            "<",
        ),
        Row(
            "and their circle is smaller",
            section,
            LEVEL,
            radii[0],
            radii[1],
            0.0,
            "m",
            "<",
        ),
    ]


def walking_speeds(result: DuelResult) -> tuple[float, float]:
    """Speeds of pursuer and evader over the last third, in [m/s].

    Chords of a gait cycle, so that the sway does not count as way.
    """
    arrays = result.arrays
    times = arrays["times_s"]
    cycle = round(
        2.0 * result.settings.gait.step_duration / float(times[1] - times[0])
    )

    def speed(name: str) -> float:
        torso: Array = arrays[f"{name}_torso"][len(times) * 2 // 3 :, :2]
        way = np.hypot(*(torso[cycle:] - torso[:-cycle]).T)
        return float(way.mean() / (cycle * (times[1] - times[0])))

    return speed("pursuer"), speed("evader")


def _mean_radius(summary: dict[str, Any]) -> float:
    radii = [summary[name]["radius_m"] for name in ("pursuer", "evader")]
    return float(np.mean(radii))
