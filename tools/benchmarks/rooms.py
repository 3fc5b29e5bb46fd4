r"""Run duels in rooms of 3 x 3 m with three discs, in physics.

Rows of other strategies and maps in the output remain::

    python tools/benchmarks/rooms.py --strategy evasion --map given \
        --seeds 0:10

``--summarise`` only recomputes the summary from the rows.
"""

import json
from pathlib import Path
from typing import NamedTuple

from benchmark_options import ask, machine, seeds_of
from result_files import header, read_result, write_result
from resumable_jobs import Row, finished, gather, spread

from stepaside.arena import RoomRecipe, generate_room
from stepaside.core.constants import CAPTURE_DISTANCE
from stepaside.games import duel, run_game
from stepaside.locomotion.control_settings import MAPS, MapSettings
from stepaside.studies.tournament import clearance

RECIPE = RoomRecipe(discs=3)
PLAYERS = ("pursuer", "evader")


class Played(NamedTuple):
    """Duel to run."""

    strategy: str
    map: str
    seed: int
    duration: float


def play(played: Played) -> Row:
    """Return outcome, contacts and clearances of one duel."""
    seen = played.map == "seen"
    settings = duel(
        seed=played.seed,
        duration=played.duration,
        evader={"strategy": played.strategy},
        senses="cameras" if seen else "ideal",
        room=generate_room(RECIPE, played.seed),
        map=MapSettings(source=played.map),
    )
    run = run_game(settings)
    summary = run.results()
    return {
        "strategy": played.strategy,
        "map": played.map,
        "seed": played.seed,
        "outcome": run.outcome.value,
        "touched": summary.get("touched", []),
        "survived_s": run.duration,
        "closest_m": summary["min_distance_m"],
        "plan_time_median_us": summary["planning"]["median_us"],
        "plan_time_p99_us": summary["planning"]["p99_us"],
        **{f"{name}_clearance_m": clearance(run, name) for name in PLAYERS},
    }


def summary_of(rows: list[Row]) -> Row:
    """Return the summary of the duels of one strategy with one map."""
    outcomes = [row["outcome"] for row in rows]
    contacts = [row for row in rows if row["outcome"] == "contact"]
    players = sum(set(row["touched"]) == set(PLAYERS) for row in contacts)
    both = [row[f"{name}_clearance_m"] for row in rows for name in PLAYERS]
    return {
        "strategy": rows[0]["strategy"],
        "map": rows[0]["map"],
        "pursuer": "pursuit",
        "duels": len(rows),
        "untouched": outcomes.count("completed"),
        "captured": sum(row["closest_m"] <= CAPTURE_DISTANCE for row in rows),
        "capture_distance_m": CAPTURE_DISTANCE,
        "contact": players,
        "touched_room": len(contacts) - players,
        "fell": outcomes.count("fall"),
        "other": len(rows)
        - sum(outcomes.count(o) for o in ("completed", "contact", "fall")),
        "survived_s": spread([row["survived_s"] for row in rows]),
        "closest_m": spread([row["closest_m"] for row in rows]),
        "clearance_m": spread(both),
        "plan_time_p99_us": spread([r["plan_time_p99_us"] for r in rows]),
    }


def others(output: Path, strategy: str, source: str) -> list[Row]:
    """Return the existing rows of other duels."""
    if not output.is_file():
        return []
    found: list[Row] = json.loads(output.read_text("utf-8"))["rows"]
    return [
        r for r in found if (r["strategy"], r["map"]) != (strategy, source)
    ]


def summaries(rows: list[Row]) -> list[Row]:
    """Return the summary for each strategy and map."""
    kinds: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        kinds.setdefault((row["strategy"], row["map"]), []).append(row)
    return [summary_of(kind) for kind in kinds.values()]


def main() -> None:
    """Run the duels and write the results."""
    asked = ask(__doc__, "rooms.json")
    asked.add_argument("--strategy", default="evasion")
    asked.add_argument("--map", choices=MAPS, default="given")
    asked.add_argument("--seeds", type=seeds_of, default="0:10")
    asked.add_argument("--duration", type=float, default=120.0)
    asked.add_argument("--workers", type=int)
    asked.add_argument("--summarise", action="store_true")
    arguments = asked.parse_args()
    output = arguments.output
    if arguments.summarise:
        result = read_result(output)
        write_result(output, result | {"summary": summaries(result["rows"])})
        return
    settings = {
        "size_m": [RECIPE.width, RECIPE.depth],
        "discs": RECIPE.discs,
        "seeds": [arguments.seeds.start, arguments.seeds.stop],
        "duration_s": arguments.duration,
    }
    head = header(settings)
    jobs = {
        f"{arguments.strategy} {arguments.map} {seed}": Played(
            arguments.strategy, arguments.map, seed, arguments.duration
        )
        for seed in arguments.seeds
    }
    rows = others(output, arguments.strategy, arguments.map)
    rows += gather(output, head, jobs, play, arguments.workers).values()
    write_result(
        output,
        head,
        machine=machine(),
        summary=summaries(rows),
        rows=rows,
    )
    finished(output)


if __name__ == "__main__":
    main()
