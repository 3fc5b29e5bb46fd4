"""Simulate people approaching or passing a robot with the fast gait.

The initial poses are those of ``stepaside duel --pursuer person --person-path
straight --gait fast``: from ahead within 30 degrees, at a walking distance of
5 s. Fifty seeds of each kind; an interrupted run continues from the records
in ``runs/comers``::

    python tools/benchmarks/fast_gait_people.py --seeds 0:50
"""

from dataclasses import replace
from pathlib import Path

from benchmark_options import ask, seeds_of
from resumable_jobs import complete

from stepaside.games.duel_settings import DuelSettings
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.planning import PRESETS
from stepaside.sim.body_settings import BODIES
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion
from stepaside.studies.duel_campaign import duel_study
from stepaside.studies.result_files import header, write_result
from stepaside.studies.tabulation import Record

FAST = DuelSettings(
    duration=16.0,
    gait=PRESETS["fast"],
    control=ControlSettings(feedback=True),
    strategy=Evasion(trigger="time"),
    pursuer="person",
)
SEES = replace(FAST, sensing="cameras")
KINDS = {
    "ideal-sight": replace(FAST, person=PersonSettings("straight", 1.0)),
    "cameras": replace(SEES, person=PersonSettings("straight", 0.8)),
    "cameras-passing": replace(
        SEES, person=PersonSettings("straight", 0.8, miss=1.2)
    ),
    "hardware-cameras": replace(
        SEES,
        duration=20.0,
        body=BODIES["hardware"],
        person=PersonSettings("straight", 0.5),
    ),
}


def row_of(kind: str, records: list[Record]) -> Record:
    """Return the summary of the duels of one kind."""
    settings = KINDS[kind]
    begun = [r["triggered_at_distance_m"] for r in records]
    known = [away for away in begun if away is not None]
    outcomes = [record["outcome"] for record in records]
    closest = [record["min_distance_m"] for record in records]
    return {
        "kind": kind,
        "body": next(k for k, body in BODIES.items() if body == settings.body),
        "sensing": settings.sensing,
        "speed_m_s": settings.person.speed,
        "miss_m": settings.person.miss,
        "number": len(records),
        "contacts": outcomes.count("contact"),
        "falls": outcomes.count("fall"),
        "begun": len(known),
        "begun_at_m": sum(known) / len(known) if known else None,
        "closest_m": min(closest),
        "mean_closest_m": sum(closest) / len(closest),
    }


def main() -> None:
    """Simulate the duels and write the results."""
    parser = ask(__doc__, "people-fast-gait.json")
    parser.add_argument("--seeds", type=seeds_of, default=range(0, 50))
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--records", type=Path, default=Path("runs/comers"))
    parser.add_argument("--workers", type=int)
    asked = parser.parse_args()
    rows: list[Record] = []
    for kind in asked.kinds:
        study = duel_study(KINDS[kind], asked.seeds)
        file = asked.records / f"{kind}.sqlite"
        run = complete(study, file, asked.workers)
        rows.append(row_of(kind, list(run.records())))
    seeds = [asked.seeds.start, asked.seeds.stop]
    head = header({"seeds": seeds})
    write_result(asked.output, head, rows=rows)


if __name__ == "__main__":
    main()
