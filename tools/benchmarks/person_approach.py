"""Simulate people walking towards an evader with ideal sensing or cameras.

::

    python tools/benchmarks/person_approach.py ideal --seeds 1:6
    python tools/benchmarks/person_approach.py cameras --seeds 1:3

A person does not wear the colours of a robot, so colour images contain no
detections: with cameras, two images per second are ray cast. Depth images
have their usual rate.
"""

from typing import NamedTuple

from benchmark_options import ask, seeds_of
from result_files import header, write_result
from resumable_jobs import Row, finished, gather, spread

from stepaside.games import duel, run_game
from stepaside.sim.camera_settings import CameraSettings, ColourSettings
from stepaside.sim.person_settings import PersonSettings

DURATION = 90.0  # duration of each duel, in [s]
WALKS = {
    "steers-slowly": PersonSettings("steer", 0.073, 0.146),
    "steers": PersonSettings("steer", 0.15, 0.2),
    "straight": PersonSettings("straight", 0.15),
    "past": PersonSettings("straight", 0.15, miss=1.2),
}
CAMERAS = CameraSettings(colour=ColourSettings(renderer="raycast", rate=2.0))
FIGURES = ("triggered_at_distance_m", "min_distance_m", "theory_closest_m")


class Walk(NamedTuple):
    """Path of the person, and sensing of the evader."""

    name: str
    seed: int
    sensing: str


def play(walk: Walk) -> Row:
    """Return the values of one duel with a person."""
    settings = duel(
        seed=walk.seed,
        duration=DURATION,
        pursuer={"body": "person"},
        person=WALKS[walk.name],
        senses=walk.sensing,
        cameras=CAMERAS,
    )
    found = run_game(settings).results()
    return {
        "walk": walk.name,
        "seed": walk.seed,
        "outcome": found["outcome"],
        "message": found["message"],
        "triggered_at_distance_m": found["triggered_at_distance_m"],
        "min_distance_m": found["min_distance_m"],
        "theory_closest_m": found["theory"]["min_distance_m"],
    }


def together(rows: list[Row]) -> Row:
    """Return the outcomes of some duels, and the range of each value."""
    outcomes = [row["outcome"] for row in rows]
    return {
        "number": len(rows),
        "contacts": outcomes.count("contact"),
        "falls": outcomes.count("fall"),
        **{key: spread([row[key] for row in rows]) for key in FIGURES},
    }


def main() -> None:
    """Simulate the duels and write the results."""
    asked = ask(__doc__, lambda given: f"person-{given.sensing}.json")
    asked.add_argument("sensing", choices=["ideal", "cameras"])
    asked.add_argument("--seeds", type=seeds_of, default="1:6")
    asked.add_argument(
        "--slow", type=seeds_of, help="seeds of who steers slowly, if others"
    )
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    seeds, sensing = arguments.seeds, arguments.sensing
    each = {name: seeds for name in WALKS}
    if arguments.slow is not None:
        each["steers-slowly"] = arguments.slow
    output = arguments.output
    jobs = {
        f"{name}/{seed}": Walk(name, seed, sensing)
        for name in WALKS
        for seed in each[name]
    }
    libraries = ["mujoco", "numpy"]
    if sensing == "cameras":
        libraries.append("opencv-python-headless")
    settings = {
        "sensing": sensing,
        "seeds": {name: [s.start, s.stop] for name, s in each.items()},
        "duration_s": DURATION,
    }
    head = header(settings)
    rows = gather(output, head, jobs, play, arguments.workers)
    walks = {
        name: together([rows[f"{name}/{seed}"] for seed in each[name]])
        for name in WALKS
    }
    write_result(output, head, walks=walks, rows=list(rows.values()))
    finished(output)


if __name__ == "__main__":
    main()
