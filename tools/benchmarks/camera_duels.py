"""Run duels of robots with cameras, in an empty or a degraded setting.

Degraded means 30 % of the images dropped, 100 ms more latency, and boxes
and a mannequin in the room::

    python tools/benchmarks/camera_duels.py plain --seeds 302:309
    python tools/benchmarks/camera_duels.py degraded --seeds 302:305
"""

from typing import NamedTuple

from benchmark_options import ask, machine, seeds_of
from result_files import header, write_result
from resumable_jobs import Row, finished, gather, spread

from stepaside.games import duel, run_game
from stepaside.sim.camera_settings import (
    CLUTTER,
    CameraSettings,
    SceneSettings,
)

BEYOND = 0.85  # start distance for a meaningful trigger, in [m]
LIBRARIES = ("mujoco", "numpy", "opencv-python-headless")
RATES = ("detection_rate", "false_detections")
PLAIN = (
    "distance_m",
    "relative_orientation_deg",
    "converged_at_s",
    "min_distance_m",
    "real_time_factor",
)


class Seen(NamedTuple):
    """Duel to run."""

    kind: str
    seed: int


def play(seen: Seen) -> Row:
    """Return the values of one duel of 120 s."""
    settings = duel(seed=seen.seed, senses="cameras")
    if seen.kind == "degraded":
        settings = duel(
            seed=seen.seed,
            senses="cameras",
            cameras=CameraSettings(drop_frames=0.3, added_latency=0.1),
            scene=SceneSettings(things=list(CLUTTER)),
        )
    run = run_game(settings)
    found = run.results()
    row = {key: found[key] for key in PLAIN} | {
        key: found["sight"][key] for key in RATES
    }
    for name in ("pursuer", "evader"):
        row[f"{name}_misled_s"] = found["players"][name]["sight"]["misled_s"]
        for which in ("median", "p95"):
            key = f"bearing_error_{which}_deg"
            error = found["players"][name]["sight"][key]
            row[f"{name}_bearing_error_{which}_deg"] = error
    away = found["players"]["evader"]["sight"]["distance_error_median_m"]
    row["evader_distance_error_median_m"] = away
    begun = run.settings.start.distance
    at = found["triggered_at_distance_m"]
    row["triggered_at_distance_m"] = at if begun > BEYOND else None
    return {
        "seed": seen.seed,
        "outcome": found["outcome"],
        "camera": found["sight"]["camera"],
        **row,
    }


def main() -> None:
    """Run the duels and write the results."""
    asked = ask(__doc__, lambda given: f"camera-errors-{given.kind}.json")
    asked.add_argument("kind", choices=["plain", "degraded"])
    asked.add_argument("--seeds", type=seeds_of, default="302:309")
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    seeds, kind = arguments.seeds, arguments.kind
    output = arguments.output
    settings = {
        "kind": kind,
        "seeds": [seeds.start, seeds.stop],
        "duration_s": 120.0,
    }
    head = header(settings)
    jobs = {str(seed): Seen(kind, seed) for seed in seeds}
    found = gather(output, head, jobs, play, arguments.workers)
    rows = list(found.values())
    outcomes = [row["outcome"] for row in rows]
    names = [
        key for key in rows[0] if key not in ("seed", "outcome", "camera")
    ]
    write_result(
        output,
        head,
        machine=machine(),
        number=len(rows),
        falls=outcomes.count("fall"),
        contacts=outcomes.count("contact"),
        cameras=sorted({row["camera"] for row in rows}),
        summary={key: spread([row[key] for row in rows]) for key in names},
        rows=rows,
    )
    finished(output)


if __name__ == "__main__":
    main()
