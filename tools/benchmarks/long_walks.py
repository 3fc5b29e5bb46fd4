"""Simulate long walks of hardware bodies: forward, backward and in circles.

::

    python tools/benchmarks/long_walks.py --minutes 60
"""

from dataclasses import replace
from math import radians

from benchmark_options import ask
from parallel_walks import walk_all

from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.control_settings import STABILISED
from stepaside.sim.body_settings import BODIES

KEPT = ("outcome", "duration_s", "steps", "speed_ratio", "yaw_ratio")


def main() -> None:
    """Simulate the walks and write the results."""
    asked = ask(__doc__, "long-walks.json")
    asked.add_argument("--minutes", type=float, default=60.0)
    asked.add_argument("--seed", type=int, default=7)
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    straight = WalkSettings(
        seed=arguments.seed,
        duration=60.0 * arguments.minutes,
        body=BODIES["hardware"],
        control=STABILISED,
    )
    jobs = {
        "forward": straight,
        "backward": replace(straight, backward=True),
        "turning": replace(straight, bearing=radians(45.0)),
    }
    settings = {
        "body": "hardware",
        "method": "measured",
        "seed": arguments.seed,
        "minutes": arguments.minutes,
        "turning_bearing_deg": 45.0,
    }
    walk_all(arguments, settings, jobs, KEPT)


if __name__ == "__main__":
    main()
