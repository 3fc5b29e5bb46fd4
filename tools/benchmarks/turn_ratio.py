"""Measure which fraction of planned turn and speed an ideal body achieves.

Open-loop walks with a constant bearing, forward and backward, to both sides::

    python tools/benchmarks/turn_ratio.py
"""

from math import degrees, radians

from benchmark_options import ask
from resumable_jobs import Row, finished, gather, spread

from stepaside.games.run_archive import results_of
from stepaside.games.walk_game import run_walk
from stepaside.games.walk_settings import WalkSettings
from stepaside.studies.result_files import header, write_result

DURATION = 40.0  # [s]
BEARINGS = [
    radians(angle) for angle in (-60.0, -45.0, -20.0, 20.0, 45.0, 60.0)
]
KEYS = ("speed_ratio", "yaw_ratio", "slip_per_step_m")


def walk(settings: WalkSettings) -> Row:
    """Return the values of one walk."""
    summary = results_of(run_walk(settings))
    return {key: summary[key] for key in ("outcome", *KEYS)}


def main() -> None:
    """Simulate the walks and write the results."""
    parser = ask(__doc__, "turn-ratio.json")
    parser.add_argument("--workers", type=int)
    asked = parser.parse_args()
    head = header({"duration_s": DURATION, "bearings_rad": BEARINGS})
    jobs = {
        f"{way} {degrees(bearing):.0f}": WalkSettings(
            duration=DURATION, bearing=bearing, backward=way == "backward"
        )
        for way in ("forward", "backward")
        for bearing in BEARINGS
    }
    rows = gather(asked.output, head, jobs, walk, asked.workers)
    found = {key: spread([row[key] for row in rows.values()]) for key in KEYS}
    write_result(asked.output, head, walks=rows, **found)
    finished(asked.output)


if __name__ == "__main__":
    main()
