"""Measure what a walk of the hardware body survives, as a second campaign.

Like ``stepaside robustness --body hardware``, into a file of results::

    python tools/benchmarks/walk_survival.py --seeds 6 --phases 4
"""

from benchmark_options import ask
from resumable_jobs import Row, complete, finished, part_of

from stepaside.studies.push_limits import push_cases
from stepaside.studies.result_files import header, write_result
from stepaside.studies.robustness_campaign import push_study, robustness_study
from stepaside.studies.robustness_trial import METHODS, STRENGTHS, trials
from stepaside.studies.survival_statistics import (
    limit_rows,
    push_survival_rows,
    survival_rows,
)

BODY = "hardware"


def by_strength(rows: list[Row]) -> dict[str, dict[str, Row]]:
    """Return trials and falls over all directions, by kind and strength."""
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
    """Simulate the walks and write the results."""
    asked = ask(__doc__, "survival-hardware.json")
    asked.add_argument("--seeds", type=int, default=6)
    asked.add_argument("--phases", type=int, default=4)
    asked.add_argument("--method", choices=METHODS, default="measured")
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    methods = (arguments.method,)
    grid = list(trials(STRENGTHS, methods, BODY, seeds=arguments.seeds))
    cases = list(push_cases(methods, BODY, phases=arguments.phases))
    settings = {
        "body": BODY,
        "method": arguments.method,
        "seeds": arguments.seeds,
        "phases": arguments.phases,
    }
    head = header(settings)
    part = part_of(arguments.output)
    walks = complete(robustness_study(grid), part, arguments.workers)
    searches = complete(push_study(cases), part, arguments.workers)
    limits = limit_rows(searches.items())
    pushed = sum(len(record["strengths"]) for record in searches.records())
    rows = survival_rows(walks.items()) + push_survival_rows(limits)
    write_result(
        arguments.output,
        head,
        trials=walks.finished + pushed,
        by=by_strength(rows),
        survival=rows,
        limits=limits,
    )
    finished(arguments.output)


if __name__ == "__main__":
    main()
