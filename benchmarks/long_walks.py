"""Let hardware-like bodies walk for long: forward, backward and in circles.

::

    python benchmarks/long_walks.py --minutes 60
"""

from dataclasses import replace
from math import radians

from asking import ask
from gathering import Row, finished, gather

from stepaside.control.balance.settings import STABILISED
from stepaside.games.walk import run_walk
from stepaside.games.walk_settings import WalkSettings
from stepaside.studies.results import header, write_result
from stepaside.world.body_settings import BODIES

KEPT = ("outcome", "duration_s", "steps", "speed_ratio", "yaw_ratio")


def walk(settings: WalkSettings) -> Row:
    """Figures of one walk."""
    found = run_walk(settings).summary.to_json()
    return {key: found[key] for key in KEPT}


def main() -> None:
    """Walk and write."""
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
    head = header(settings)
    walks = gather(arguments.output, head, jobs, walk, arguments.workers)
    falls = sum(row["outcome"] != "completed" for row in walks.values())
    write_result(arguments.output, head, falls=falls, walks=walks)
    finished(arguments.output)


if __name__ == "__main__":
    main()
