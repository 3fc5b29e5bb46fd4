"""Play duels in rooms of 3 x 3 m with three discs, in physics.

Rows of other strategies and maps that stand in the output already stay::

    python benchmarks/rooms.py --strategy evasion --map given --seeds 0:10
"""

import json
from pathlib import Path
from typing import NamedTuple

from asking import ask, machine, seeds_of
from gathering import Row, finished, gather, spread

from stepaside.control.clearance.settings import MAPS, MapSettings
from stepaside.games import DuelSettings, run_duel
from stepaside.rooms import RoomRecipe, make_room
from stepaside.studies.physics_game import clearance, outcome_of
from stepaside.studies.results import header, write_result
from stepaside.world.camera_settings import RoomSettings

RECIPE = RoomRecipe(discs=3)
PLAYERS = ("pursuer", "evader")


class Played(NamedTuple):
    """One duel to play."""

    strategy: str
    map: str
    seed: int
    duration: float


def play(played: Played) -> Row:
    """Outcome of one duel, who touched what, and how clear they kept."""
    seen = played.map == "seen"
    settings = DuelSettings(
        seed=played.seed,
        duration=played.duration,
        evader_strategy=played.strategy,
        sensing="cameras" if seen else "ideal",
        room=RoomSettings(plan=make_room(RECIPE, played.seed)),
        map=MapSettings(source=played.map),
    )
    run = run_duel(settings)
    summary = run.summary.to_json()
    return {
        "strategy": played.strategy,
        "map": played.map,
        "seed": played.seed,
        "outcome": run.outcome.value,
        "touched": summary.get("touched", []),
        "caught": outcome_of(run) == "caught",
        "survived_s": run.duration,
        "closest_m": summary["min_distance_m"],
        "plan_time_median_us": summary["plan_time_us"]["median"],
        "plan_time_p99_us": summary["plan_time_us"]["p99"],
        **{f"{name}_clearance_m": clearance(run, name) for name in PLAYERS},
    }


def summary_of(rows: list[Row]) -> Row:
    """What the duels of one strategy with one map came to."""
    outcomes = [row["outcome"] for row in rows]
    contacts = [row for row in rows if row["outcome"] == "contact"]
    both = [row[f"{name}_clearance_m"] for row in rows for name in PLAYERS]
    return {
        "strategy": rows[0]["strategy"],
        "map": rows[0]["map"],
        "duels": len(rows),
        "untouched": outcomes.count("completed"),
        "caught": sum(row["caught"] for row in contacts),
        "touched_room": sum(not row["caught"] for row in contacts),
        "fell": outcomes.count("fall"),
        "other": len(rows)
        - sum(outcomes.count(o) for o in ("completed", "contact", "fall")),
        "survived_s": spread([row["survived_s"] for row in rows]),
        "closest_m": spread([row["closest_m"] for row in rows]),
        "clearance_m": spread(both),
        "plan_time_p99_us": spread([r["plan_time_p99_us"] for r in rows]),
    }


def others(output: Path, strategy: str, source: str) -> list[Row]:
    """Rows of what else was played before."""
    if not output.is_file():
        return []
    found: list[Row] = json.loads(output.read_text("utf-8"))["rows"]
    return [
        r for r in found if (r["strategy"], r["map"]) != (strategy, source)
    ]


def main() -> None:
    """Play and write."""
    asked = ask(__doc__, "rooms.json")
    asked.add_argument("--strategy", default="evasion")
    asked.add_argument("--map", choices=MAPS, default="given")
    asked.add_argument("--seeds", type=seeds_of, default="0:10")
    asked.add_argument("--duration", type=float, default=120.0)
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    settings = {
        "size_m": [RECIPE.width, RECIPE.depth],
        "discs": RECIPE.discs,
        "seeds": [arguments.seeds.start, arguments.seeds.stop],
        "duration_s": arguments.duration,
    }
    head = header(settings, rooms=("studies/physics_game",))
    jobs = {
        f"{arguments.strategy} {arguments.map} {seed}": Played(
            arguments.strategy, arguments.map, seed, arguments.duration
        )
        for seed in arguments.seeds
    }
    output = arguments.output
    rows = others(output, arguments.strategy, arguments.map)
    rows += gather(output, head, jobs, play, arguments.workers).values()
    kinds: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        kinds.setdefault((row["strategy"], row["map"]), []).append(row)
    write_result(
        output,
        head,
        machine=machine(),
        summary=[summary_of(kind) for kind in kinds.values()],
        rows=rows,
    )
    finished(output)


if __name__ == "__main__":
    main()
