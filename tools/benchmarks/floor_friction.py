"""Run duels of hardware bodies on two floors of different friction.

::

    python tools/benchmarks/floor_friction.py --seeds 200:230
"""

from typing import NamedTuple

from benchmark_options import ask, seeds_of
from resumable_jobs import Row, finished, gather, spread

from stepaside.games import DuelSettings, run_duel
from stepaside.games.run_archive import results_of
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.sim.body_settings import BODIES
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.studies.result_files import header, write_result

FLOORS = {
    "as it is": PhysicsSettings(),
    "friction 0.3, bumps of 3 mm": PhysicsSettings(
        friction=0.3, unevenness=0.003
    ),
}
FIGURES = ("distance_m", "relative_orientation_deg", "converged_at_s")


class Played(NamedTuple):
    """Duel to run."""

    floor: str
    seed: int


def play(played: Played) -> Row:
    """Return the values of one duel of 120 s with ``--body hardware``."""
    settings = DuelSettings(
        seed=played.seed,
        physics=FLOORS[played.floor],
        body=BODIES["hardware"],
        control=STABILISED,
    )
    found = results_of(run_duel(settings))
    return {
        "floor": played.floor,
        "seed": played.seed,
        "outcome": found["outcome"],
        "radius_m": [found[n]["radius_m"] for n in ("pursuer", "evader")],
        "min_distance_m": found["min_distance_m"],
        **{key: found[key] for key in FIGURES},
    }


def together(rows: list[Row]) -> Row:
    """Return outcomes on one floor, and the range of each value."""
    outcomes = [row["outcome"] for row in rows]
    return {
        "number": len(rows),
        "falls": outcomes.count("fall"),
        "contacts": outcomes.count("contact"),
        "radius_m": spread([r for row in rows for r in row["radius_m"]]),
        "min_distance_m": spread([row["min_distance_m"] for row in rows]),
        **{key: spread([row[key] for row in rows]) for key in FIGURES},
    }


def main() -> None:
    """Run the duels and write the results."""
    asked = ask(__doc__, "floor-friction.json")
    asked.add_argument("--seeds", type=seeds_of, default="200:230")
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    seeds: range = arguments.seeds
    settings = {
        "body": "hardware",
        "method": "measured",
        "seeds": [seeds.start, seeds.stop],
        "duration_s": 120.0,
    }
    head = header(settings)
    jobs = {
        f"{floor}/{seed}": Played(floor, seed)
        for floor in FLOORS
        for seed in seeds
    }
    rows = gather(arguments.output, head, jobs, play, arguments.workers)
    floors = {
        floor: together([rows[f"{floor}/{seed}"] for seed in seeds])
        for floor in FLOORS
    }
    write_result(
        arguments.output, head, floors=floors, rows=list(rows.values())
    )
    finished(arguments.output)


if __name__ == "__main__":
    main()
