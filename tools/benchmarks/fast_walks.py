"""Simulate walks with the fast gait: forward, backward, straight and turning.

::

    python tools/benchmarks/fast_walks.py --seeds 20
"""

from dataclasses import replace
from math import radians

from benchmark_options import ask
from parallel_walks import walk_all

from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.planning import PRESETS
from stepaside.sim.body_settings import BODIES

KEPT = (
    "outcome",
    "duration_s",
    "steps",
    "adapted_steps",
    "speed_m_s",
    "speed_ratio",
    "yaw_ratio",
    "slip_per_step_m",
    "tilt_max_deg",
)
BEARINGS = (-90, -45, 0, 45, 90)  # in [deg]


def main() -> None:
    """Simulate the walks and write the results."""
    asked = ask(__doc__, "fast-walks.json")
    asked.add_argument("--seconds", type=float, default=60.0)
    asked.add_argument("--seeds", type=int, default=20)
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    first = WalkSettings(
        duration=arguments.seconds,
        gait=PRESETS["fast"],
        control=ControlSettings("closed-form", feedback=True),
    )
    jobs = {
        f"{body}/{'backward' if backward else 'forward'}/{bearing}/{seed}": (
            replace(
                first,
                seed=seed,
                body=BODIES[body],
                bearing=radians(bearing),
                backward=backward,
            )
        )
        for body in ("ideal", "hardware")
        # The ideal body has no random parameters.
        for seed in range(1, 2 if body == "ideal" else 1 + arguments.seeds)
        for bearing in BEARINGS
        for backward in (False, True)
    }
    settings = {
        "gait": "fast",
        "method": "closed-form",
        "seconds": arguments.seconds,
        "seeds": arguments.seeds,
        "bearings_deg": BEARINGS,
    }
    walk_all(arguments, settings, jobs, KEPT)


if __name__ == "__main__":
    main()
