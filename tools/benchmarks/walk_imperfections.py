"""Measure walks: estimation errors, and the effect of each imperfection.

Rms errors of 30 s of turning walk on both bodies with ``--feedback``; then
speed, turning and slip of 25 s on the hardware body without joint correction,
with one imperfection of the body removed at a time::

    python tools/benchmarks/walk_imperfections.py --seeds 1:11
"""

from dataclasses import replace
from typing import Any

from benchmark_options import ask, seeds_of
from result_files import header, write_result
from resumable_jobs import Row, finished, gather, spread

from stepaside.games.game_settings import GameSettings
from stepaside.games.game_settings import walk as make_walk
from stepaside.games.recorded_game import run_game
from stepaside.locomotion.control_settings import (
    STABILISED,
    StabiliserSettings,
)
from stepaside.sim.body_settings import BODIES, BodySettings

BEARING = 0.3  # desired heading at every step, in [rad]
ESTIMATED = 30.0  # duration of the walks for estimation errors, in [s]
PACED = 25.0  # duration of the walks for speed, in [s]
HARDWARE, IDEAL = BODIES["hardware"], BODIES["ideal"]
QUIET = {
    name: getattr(IDEAL, name)
    for name in (
        *("encoder_step", "gyro_noise", "gyro_bias", "force_noise"),
        *("accelerometer_noise", "accelerometer_bias", "force_gain_error"),
    )
}
VARIANTS: dict[str, BodySettings] = {
    "hardware": HARDWARE,
    "no-play": replace(HARDWARE, backlash=0.0),
    "no-delay": replace(HARDWARE, delay_cycles=0, imu_delay_cycles=0),
    "ideal-torque": replace(
        HARDWARE, torque_speed=False, efficiency=1.0, servo_gain=1.0
    ),
    "no-noise": replace(HARDWARE, **QUIET),
    "exact-masses": replace(HARDWARE, mass_error=0.0, com_error=0.0),
}
CORRECTED = "corrected"
PACE = ("speed_ratio", "yaw_ratio", "slip_per_step_m")


def walk(settings: GameSettings) -> Row:
    """Return the values of one walk."""
    summary = run_game(settings).results()
    walking = summary["walking"]
    return {
        "outcome": summary["outcome"],
        **{key: walking[key] for key in PACE},
        "estimation": walking["estimation"],
    }


def walks(seeds: range) -> dict[str, GameSettings]:
    """Return all walks by ``kind/seed``."""
    feedback = STABILISED
    stiff = replace(feedback, stabiliser=StabiliserSettings(joint_gain=0.0))
    every = {}
    for seed in seeds:
        base = make_walk(seed=seed, bearing=BEARING, control=feedback)
        for name in ("ideal", "hardware"):
            every[f"{name} estimated/{seed}"] = replace(
                base, body=BODIES[name], duration=ESTIMATED
            )
        paced = replace(base, body=HARDWARE, duration=PACED)
        every[f"{CORRECTED}/{seed}"] = paced
        for name, body in VARIANTS.items():
            every[f"{name}/{seed}"] = paced.changed(body=body, control=stiff)
    return every


def main() -> None:
    """Simulate the walks and write the results."""
    asked = ask(__doc__, "walk-imperfections.json")
    asked.add_argument("--seeds", type=seeds_of, default="1:11")
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    seeds: range = arguments.seeds
    settings = {
        "seeds": [seeds.start, seeds.stop],
        "bearing_rad": BEARING,
        "estimated_s": ESTIMATED,
        "paced_s": PACED,
    }
    head = header(settings)
    rows = gather(
        arguments.output, head, walks(seeds), walk, arguments.workers
    )

    def of(kind: str) -> list[Row]:
        return [rows[f"{kind}/{seed}"] for seed in seeds]

    bodies: dict[str, Any] = {}
    for name in ("ideal", "hardware"):
        found = of(f"{name} estimated")
        bodies[name] = {
            "falls": sum(row["outcome"] != "completed" for row in found),
            "estimation": {
                key: spread([row["estimation"][key] for row in found])
                for key in found[0]["estimation"]
            },
        }
    variants = {
        name: {key: spread([row[key] for row in of(name)]) for key in PACE}
        | {"falls": sum(r["outcome"] != "completed" for r in of(name))}
        for name in (*VARIANTS, CORRECTED)
    }
    write_result(arguments.output, head, bodies=bodies, variants=variants)
    finished(arguments.output)


if __name__ == "__main__":
    main()
