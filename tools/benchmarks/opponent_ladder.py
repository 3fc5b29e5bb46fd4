"""Play evaders against a ladder of pursuers in empty rooms and in the open.

Beside them stands an offline search that knows the pursuer's law: a beam of
4,000 states over the whole game. In physics humanoids play for a minute.
Results are written::

    python tools/benchmarks/opponent_ladder.py --records runs/ladder
    python tools/benchmarks/opponent_ladder.py --in-room sharp,noisy:20

NAME@RATIO is a pursuer of RATIO times the evader's speed, NAME:N plays the
first N of the seeds only. Games and searches recorded in a
folder (``--records``) are not repeated, and an interrupted run continues. The
rank of the beam was chosen on seeds 1000 to 1006.
"""

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from benchmark_options import ask, machine, seeds_of
from names import name_and_speed
from resumable_jobs import complete, gather

from stepaside.arena import RoomRecipe
from stepaside.strategies.robust_evasion import actions_of
from stepaside.strategies.search.beam_search import beam_search
from stepaside.strategies.search.step_motion import BeamRules, PursuerModel
from stepaside.strategies.strategy_game import StepGame
from stepaside.studies.result_files import header, write_result
from stepaside.studies.tournament_campaign import tournament_study
from stepaside.studies.tournament_rows import tournament_rows
from stepaside.studies.tournament_settings import TournamentSettings

ROOM, OPEN = RoomRecipe(), RoomRecipe(None, None)
WIDTH = 4000  # states of the offline search
EVADERS = ("look-ahead", "robust")
IN_ROOM = (
    *("pursuit(gain=0.7)", "pursuit", "pursuit(gain=2)", "pursuit(gain=3)"),
    *("pursuit(gain=4)", "pursuit@0.8", "pursuit@1.1", "pursuit@1.3"),
    *("sharp", "herding", "lead", "optimal-pursuit", "noisy"),
    "stop-and-wait",
)
IN_OPEN = (
    *("pursuit", "pursuit@1.1", "pursuit@1.3", "sharp", "optimal-pursuit"),
)
IN_PHYSICS = (
    *("sharp:20", "herding:20", "pursuit:20", "pursuit(gain=3):20"),
    *("stop-and-wait:20", "noisy:20"),
)
PHYSICS = TournamentSettings("physics", ROOM, StepGame(duration=60.0))
MODELS = {  # of pursuers that capture somebody
    "pursuit(gain=3)": PursuerModel(3.0),
    "pursuit(gain=4)": PursuerModel(4.0),
    "pursuit@1.1": PursuerModel(speed=1.1),
    "pursuit@1.3": PursuerModel(speed=1.3),
    "sharp": PursuerModel(1.0 / 0.08),
    "herding": PursuerModel(pull=1.0),
}


class OfflineSearch(NamedTuple):
    """One offline search.

    Attributes:
        pursuer: Name of the pursuer, of ``MODELS``.
        seed: Seed of the room.
        width: States of the beam.
        duration: Duration of the game, in [s].
    """

    pursuer: str
    seed: int
    width: int
    duration: float


def survive(search: OfflineSearch) -> dict[str, Any]:
    """Return the survival time of an offline search, in [s]."""
    settings = TournamentSettings(room=ROOM)
    game = settings.game
    room, (chaser, evader) = settings.arena(search.seed)
    rules = BeamRules(
        game.stride, game.share, pi * game.share, game.capture,
        game.body_radius, search.width, round(search.duration / game.period),
    )  # fmt: skip
    path = beam_search(
        np.array([*evader, *chaser]),
        actions_of(pi * game.share),
        MODELS[search.pursuer],
        room.solid_set.packed,
        rules,
    )
    return {"survived_s": len(path) * game.period}


def pursuers_of(text: str, seeds: range) -> dict[str, range]:
    """Return the pursuers of NAME,NAME:N,... with the seeds of each."""
    found = {}
    for each in filter(None, text.split(",")):
        name, _, number = each.partition(":")
        found[name] = seeds[: int(number)] if number else seeds
    return found


def main() -> None:
    """Play, search, and write the results."""
    asked = ask(__doc__, "opponent-ladder.json")
    asked.add_argument("--seeds", type=seeds_of, default=range(3000, 3200))
    asked.add_argument("--in-room", default=",".join(IN_ROOM))
    asked.add_argument("--in-open", default=",".join(IN_OPEN))
    asked.add_argument("--in-physics", default=",".join(IN_PHYSICS))
    asked.add_argument("--offline", type=int, default=20)
    asked.add_argument("--workers", type=int)
    asked.add_argument("--records", type=Path, default=Path("runs/ladder"))
    arguments = asked.parse_args()
    head = header(
        {
            "seeds": f"{arguments.seeds.start}:{arguments.seeds.stop}",
            "width": WIDTH,
        }
    )
    worlds: dict[str, Any] = {}
    for world, settings, text in (
        ("3 x 3 m", TournamentSettings(room=ROOM), arguments.in_room),
        ("open floor", TournamentSettings(room=OPEN), arguments.in_open),
        ("3 x 3 m, physics, 60 s", PHYSICS, arguments.in_physics),
    ):
        rows: list[dict[str, Any]] = []
        offline: dict[str, list[float]] = {}
        for pursuer, seeds in pursuers_of(text, arguments.seeds).items():
            name, ratio = name_and_speed(pursuer)
            game = replace(settings.game, pursuer_speed_ratio=ratio)
            played = replace(settings, game=game)
            pairings = [(evader, name) for evader in EVADERS]
            study = tournament_study(played, pairings, seeds)
            run = complete(
                study, arguments.records / "games.sqlite", arguments.workers
            )
            records = list(run.records())
            made = tournament_rows(records, game)
            if pursuer in MODELS and world == "3 x 3 m":
                duration = settings.game.duration
                jobs = {
                    f"{pursuer}-{seed}": OfflineSearch(
                        pursuer, seed, WIDTH, duration
                    )
                    for seed in seeds[: arguments.offline]
                }
                found = gather(
                    arguments.records / "offline", head, jobs, survive,
                    arguments.workers,
                )  # fmt: skip
                offline[pursuer] = [
                    row["survived_s"] for row in found.values()
                ]
            searched = seeds[: len(offline.get(pursuer, []))]
            for row in made:
                row["pursuer"] = pursuer
                row["survival_in_searched_rooms_s"] = [
                    record["survived_s"]
                    for record in records
                    if record["evader"] == row["evader"]
                    and record["seed"] in searched
                ]
            rows += made
            for row in made:
                print(
                    world, row["evader"], pursuer, row["survived"],
                    round(row["mean_survival_s"], 1), offline.get(pursuer),
                    flush=True,
                )  # fmt: skip
        worlds[world] = {"rows": rows, "offline_s": offline}
    write_result(arguments.output, head, machine=machine(), worlds=worlds)


if __name__ == "__main__":
    main()
