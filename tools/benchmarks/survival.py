"""Measure what a walk of the hardware body survives, as a second campaign.

Like ``stepaside robustness --body hardware``, into a file of results::

    python tools/benchmarks/survival.py --seeds 6 --phases 4
"""

from asking import ask
from gathering import Row, finished, part_of

from stepaside.core.worker_pool import worker_pool
from stepaside.studies.push_limits import push_cases, search_limits
from stepaside.studies.push_results import MODULES
from stepaside.studies.result_files import header, write_result
from stepaside.studies.robustness_campaign import (
    METHODS,
    STRENGTHS,
    run_campaign,
    trials,
)
from stepaside.studies.survival import (
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
    head = header(settings, modules=MODULES)
    part = part_of(arguments.output)
    with worker_pool(arguments.workers) as executor:
        results = run_campaign(grid, part, executor)
        results = results | search_limits(cases, part, executor)
    limits = limit_rows(cases, results)
    rows = survival_rows(grid, results) + push_survival_rows(limits)
    write_result(
        arguments.output,
        head,
        trials=len(results),
        by=by_strength(rows),
        survival=rows,
        limits=limits,
    )
    finished(arguments.output)


if __name__ == "__main__":
    main()
