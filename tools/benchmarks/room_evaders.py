"""Measure evaders in rooms: survival, closest approach and floor area used.

Runs tournaments at the level of steps and writes the results::

    python tools/benchmarks/room_evaders.py --seeds 1000:1300 --small 1000:1050

Games recorded in a file (``--records``) are not repeated. No setting of an
evader was tuned on seeds from 1000 on.
"""

from pathlib import Path
from typing import Any

from benchmark_options import ask, machine, seeds_of

from stepaside.arena import RoomRecipe
from stepaside.studies.executors import open_executor
from stepaside.studies.result_files import header, write_result
from stepaside.studies.study import run_study
from stepaside.studies.tournament_campaign import tournament_study
from stepaside.studies.tournament_rows import tournament_rows
from stepaside.studies.tournament_settings import TournamentSettings
from stepaside.studies.tournament_strategies import ASIDE, EVADERS

WORLDS = {
    "open floor": RoomRecipe(None, None),
    "3 x 3 m": RoomRecipe(),
    "3 x 3 m, 3 discs": RoomRecipe(discs=3),
}
SIZES = (1.8, 2.0, 2.2, 2.5, 3.0, 4.0, 6.0)  # sides of square rooms, in [m]
IN_SMALL = ("look-ahead", ASIDE)
PURSUERS = (
    "pursuit",
    *(f"pursuit(gain={gain:g})" for gain in (1.5, 2, 2.5, 2.8, 3, 4)),
    *("sharp", "herding", "lead", "optimal-pursuit"),
)
MET = (  # room and evader that play against all pursuers
    *(("open floor", ASIDE), ("open floor", "look-ahead")),
    *(("3 x 3 m", "look-ahead"), ("3 x 3 m, 3 discs", "look-ahead")),
)


def main() -> None:
    """Run the tournaments and write the results."""
    asked = ask(__doc__, "room-evaders.json")
    asked.add_argument("--seeds", type=seeds_of, default=range(1000, 1300))
    asked.add_argument("--small", type=seeds_of, default=range(1000, 1050))
    asked.add_argument("--workers", type=int)
    asked.add_argument("--records", type=Path)
    arguments = asked.parse_args()
    with open_executor("processes", arguments.workers) as executor:

        def rows(
            recipe: RoomRecipe, pairings: list[tuple[str, str]], seeds: range
        ) -> list[dict[str, Any]]:
            settings = TournamentSettings(room=recipe)
            study = tournament_study(settings, pairings, seeds)
            run = run_study(study, arguments.records, executor=executor)
            if not run.completed:
                raise run.failure or KeyboardInterrupt
            return tournament_rows(list(run.records()), settings.game)

        papers = [(name, "pursuit") for name in EVADERS]
        worlds = {
            name: rows(recipe, papers, arguments.seeds)
            for name, recipe in WORLDS.items()
        }
        opponents = [
            {
                "world": world,
                "evader": evader,
                "rows": rows(
                    WORLDS[world],
                    [(evader, pursuer) for pursuer in PURSUERS],
                    arguments.small,
                ),
            }
            for world, evader in MET
        ]
        sizes = [
            {
                "size_m": size,
                "rows": rows(
                    RoomRecipe(size, size),
                    [(name, "pursuit") for name in IN_SMALL],
                    arguments.small,
                ),
            }
            for size in SIZES
        ]
    told = {
        "seeds": f"{arguments.seeds.start}:{arguments.seeds.stop}",
        "small": f"{arguments.small.start}:{arguments.small.stop}",
    }
    head = header(told)
    write_result(
        arguments.output,
        head,
        machine=machine(),
        worlds=worlds,
        opponents=opponents,
        sizes=sizes,
    )


if __name__ == "__main__":
    main()
