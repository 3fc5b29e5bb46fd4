"""Simulate walks with the fast gait: forward, backward, straight and turning.

::

    python tools/benchmarks/fast_walks.py --seeds 20
"""

from math import radians

from benchmark_options import ask
from result_files import header, write_result
from resumable_jobs import Row, finished, gather

from stepaside.games.game_settings import GameSettings, walk
from stepaside.games.recorded_game import run_game
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


def play(settings: GameSettings) -> Row:
    """Return the values of one walk."""
    found: Row = run_game(settings).results()
    found |= found["planning"] | found["walking"]
    return found


def main() -> None:
    """Simulate the walks and write the results."""
    asked = ask(__doc__, "fast-walks.json")
    asked.add_argument("--seconds", type=float, default=60.0)
    asked.add_argument("--seeds", type=int, default=20)
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    jobs = {
        f"{body}/{'backward' if backward else 'forward'}/{bearing}/{seed}": (
            walk(
                radians(bearing),
                backward=backward,
                seed=seed,
                duration=arguments.seconds,
                body=BODIES[body],
                gait=PRESETS["fast"],
                control=ControlSettings("closed-form", feedback=True),
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
    head = header(settings)
    whole = gather(arguments.output, head, jobs, play, arguments.workers)
    walks = {
        name: {key: row[key] for key in KEPT} for name, row in whole.items()
    }
    falls = sum(row["outcome"] != "completed" for row in walks.values())
    write_result(arguments.output, head, falls=falls, walks=walks)
    finished(arguments.output)


if __name__ == "__main__":
    main()
