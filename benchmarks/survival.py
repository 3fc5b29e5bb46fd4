"""What a walk of the hardware body survives: docs/images' second campaign.

As ``stepaside robustness --body hardware``, into a file of results::

    python benchmarks/survival.py --seeds 6 --phases 4
"""

from asking import ask
from gathering import Row, finished, gather

from stepaside.studies.results import header, write_result
from stepaside.studies.robustness import (
    METHODS,
    STRENGTHS,
    Trial,
    run_trial,
    trials,
)
from stepaside.studies.survival import survival_rows

BODY = "hardware"


def walk(trial: Trial) -> Row:
    """Whether a walk was survived."""
    return {"survived": run_trial(trial)[1]}


def by_strength(rows: list[Row]) -> dict[str, dict[str, Row]]:
    """Trials and falls over all directions, by kind and strength."""
    found: dict[str, dict[str, Row]] = {}
    for row in rows:
        strengths = found.setdefault(row["kind"], {})
        sums = strengths.setdefault(
            f"{row['strength']:g}", {"trials": 0, "falls": 0}
        )
        sums["trials"] += row["trials"]
        sums["falls"] += row["trials"] - row["survived"]
    return found


def main() -> None:
    """Walk and write."""
    asked = ask(__doc__, "survival-hardware.json")
    asked.add_argument("--seeds", type=int, default=6)
    asked.add_argument("--phases", type=int, default=4)
    asked.add_argument("--method", choices=METHODS, default="measured")
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    grid = list(
        trials(
            tuple(STRENGTHS),
            (arguments.method,),
            BODY,
            phases=arguments.phases,
            seeds=arguments.seeds,
        )
    )
    settings = {
        "body": BODY,
        "method": arguments.method,
        "seeds": arguments.seeds,
        "phases": arguments.phases,
    }
    head = header(settings)
    jobs = {trial.key: trial for trial in grid}
    found = gather(arguments.output, head, jobs, walk, arguments.workers)
    results = {key: row["survived"] for key, row in found.items()}
    rows = survival_rows(grid, results)
    write_result(
        arguments.output,
        head,
        trials=len(grid),
        by=by_strength(rows),
        survival=rows,
    )
    finished(arguments.output)


if __name__ == "__main__":
    main()
