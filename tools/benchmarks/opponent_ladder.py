"""Play evaders against a ladder of pursuers in empty rooms and in the open.

Beside them stands an offline search that knows the pursuer's law: a beam of
4,000 states over the whole game. Results are written::

    python tools/benchmarks/opponent_ladder.py --seeds 1000:1010

Games recorded in a folder (``--records``) are not repeated. The rank of the
beam was chosen on seeds 1000 to 1006.
"""

from collections.abc import Sequence
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
from benchmark_options import ask, machine, seeds_of

from stepaside.arena import RoomRecipe
from stepaside.strategies.robust_evasion import actions_of
from stepaside.strategies.search.beam_search import beam_search
from stepaside.strategies.search.pursuer_model import BeamRules, PursuerModel
from stepaside.studies.campaign import run_study
from stepaside.studies.executors import open_engine
from stepaside.studies.result_files import header, write_result
from stepaside.studies.result_store import ResultStore
from stepaside.studies.tournament_campaign import tournament_study
from stepaside.studies.tournament_rows import tournament_rows
from stepaside.studies.tournament_settings import MODULES, TournamentSettings

ROOM, OPEN = RoomRecipe(), RoomRecipe(None, None)
WIDTH = 4000  # states of the offline search
EVADERS = ("look-ahead", "robust")
IN_ROOM = (
    *("pure-x0.7", "pure", "pure-x2", "pure-x3", "pure-x4", "pure-v1.1"),
    *("sharp", "herding", "lead", "optimal", "noisy", "stop-and-wait"),
)
IN_OPEN = ("pure", "pure-v1.1", "pure-v1.3", "sharp", "optimal")
MODELS = {
    "pure-x0.7": PursuerModel(0.7),
    "pure": PursuerModel(),
    "pure-x2": PursuerModel(2.0),
    "pure-x3": PursuerModel(3.0),
    "pure-x4": PursuerModel(4.0),
    "pure-v1.1": PursuerModel(speed=1.1),
    "sharp": PursuerModel(1.0 / 0.08),
    "herding": PursuerModel(inward=1.0),
}


def offline_times(
    settings: TournamentSettings, pursuer: str, seeds: Sequence[int]
) -> list[float] | None:
    """Return the survival time of the offline search for each seed, [s].

    None if the pursuer has no model.
    """
    model = MODELS.get(pursuer)
    if model is None:
        return None
    game, times = settings.game, []
    for seed in seeds:
        room, (chaser, evader) = settings.arena(seed)
        rules = BeamRules(
            game.stride, game.share, pi * game.share, game.capture,
            game.body_radius, WIDTH, round(game.duration / game.period),
        )  # fmt: skip
        path = beam_search(
            np.array([*evader, *chaser]),
            actions_of(pi * game.share),
            model,
            room.solid_set.packed,
            rules,
        )
        times.append(len(path) * game.period)
    return times


def main() -> None:
    """Play, search, and write the results."""
    asked = ask(__doc__, "opponent-ladder.json")
    asked.add_argument("--seeds", type=seeds_of, default=range(1000, 1200))
    asked.add_argument("--in-room", default=",".join(IN_ROOM))
    asked.add_argument("--in-open", default=",".join(IN_OPEN))
    asked.add_argument("--offline", type=int, default=20)
    asked.add_argument("--workers", type=int)
    asked.add_argument("--records", type=Path)
    arguments = asked.parse_args()
    seeds = arguments.seeds
    store = arguments.records and ResultStore(arguments.records)
    worlds: dict[str, Any] = {}
    with open_engine(workers=arguments.workers) as engine:
        for world, recipe, pursuers in (
            ("3 x 3 m", ROOM, arguments.in_room.split(",")),
            ("open floor", OPEN, arguments.in_open.split(",")),
        ):
            settings = TournamentSettings(room=recipe)
            pairings = [(e, p) for p in pursuers for e in EVADERS]
            study = tournament_study(settings, pairings, seeds)
            run = run_study(study, store, engine)
            if not run.completed:
                raise run.failure or KeyboardInterrupt
            rows = tournament_rows(list(run.records()), settings.game)
            offline = {
                pursuer: offline_times(
                    settings, pursuer, seeds[: arguments.offline]
                )
                for pursuer in pursuers
                if world != "open floor"
            }
            worlds[world] = {"rows": rows, "offline_s": offline}
            for row in rows:
                print(
                    world, row["evader"], row["pursuer"], row["survived"],
                    round(row["mean_survival_s"], 1),
                    np.mean(offline.get(row["pursuer"]) or np.nan),
                )  # fmt: skip
    head = header(
        {"seeds": f"{seeds.start}:{seeds.stop}", "width": WIDTH},
        modules=MODULES,
        libraries=("numba", "numpy"),
    )
    write_result(arguments.output, head, machine=machine(), worlds=worlds)


if __name__ == "__main__":
    main()
