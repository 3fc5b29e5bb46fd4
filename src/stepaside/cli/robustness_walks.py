"""``stepaside robustness``: walks under one disturbance after the other."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .campaign_reports import (
    CampaignOutcome,
    check_records,
    gather,
    tell_campaign,
)
from .progress import show_progress

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings


class CampaignRequest(NamedTuple):
    """What a campaign is asked for; see the options for each."""

    kinds: tuple[str, ...]
    methods: tuple[str, ...]
    body: str
    phases: int
    seeds: int
    seed: int
    changes: str = ""

    def settings(self) -> dict[str, Any]:
        """What a result says of it; changes only where there are any."""
        return {k: v for k, v in self._asdict().items() if v != ""}


def plan_walks(asked: CampaignRequest) -> tuple[list[Any], list[Any]]:
    """Trials of a grid, and pushes whose limit is to be searched."""
    from ..studies.push_limits import push_cases
    from ..studies.robustness_campaign import trials

    kinds, methods, body, phases, seeds, seed, changes = asked
    grid = trials(
        *(kinds, methods, body),
        seeds=seeds,
        first_seed=seed,
        changes=changes,
    )
    if "push" not in kinds:
        return list(grid), []
    cases = push_cases(
        methods, body, phases=phases, seed=seed, changes=changes
    )
    return list(grid), list(cases)


def answer_walks(
    settings: "WalkSettings",
    body: str,
    grid: list[Any],
    cases: list[Any],
    results: dict[str, bool],
) -> dict[str, Any]:
    """What was found so far, and how much that is of what is planned.

    How many walks the limits of the pushes take is not known before.
    """
    from ..studies.push_limits import outcomes_of
    from ..studies.robustness_campaign import mass_of, push_scale
    from ..studies.survival import (
        limit_rows,
        push_survival_rows,
        summarise_limits,
        survival_rows,
    )

    limits = limit_rows(cases, results)
    scale = push_scale(settings.robot)
    walks = sum(map(len, outcomes_of(cases, results).values()))
    return {
        "body": body,
        "robot": settings.robot,
        "mass_kg": mass_of(settings.robot),
        "planned": {"trials": len(grid), "push_limits": len(cases)},
        "done": {
            "trials": sum(trial.key in results for trial in grid),
            "push_limits": len(limits),
            "push_walks": walks,
        },
        "survival": survival_rows(grid, results)
        + push_survival_rows(limits, scale),
        "limits": limits,
        "limits_by_method": summarise_limits(limits),
    }


def write_walks(
    output: Path,
    settings: "WalkSettings",
    asked: CampaignRequest,
    answer: dict[str, Any],
) -> None:
    """Write the results of a whole campaign, each file at one stroke."""
    from ..report.robustness_figure import draw_limits, draw_survival
    from ..studies.push_results import pushes_result
    from ..studies.result_files import header, write_result
    from ..studies.robustness_campaign import MODULES, UNITS

    head = header(asked.settings(), modules=MODULES)
    write_result(output / "survival.json", head, **answer)
    draw_survival(answer["survival"], UNITS, output / "survival.png")
    limits = answer["limits"]
    if limits:
        draw_limits(limits, output / "limits.png")
        made = pushes_result(
            *(limits, asked.methods, asked.body),
            phases=asked.phases,
            seed=asked.seed,
            walk=settings,
        )
        write_result(output / "pushes.json", made)


def run_walks(
    grid: list[Any], cases: list[Any], file: Path | None, workers: int | None
) -> tuple[dict[str, bool], CampaignOutcome]:
    """Run with a progress bar, and say how it ended."""
    from ..core.worker_pool import worker_pool
    from ..studies.push_limits import search_limits
    from ..studies.robustness_campaign import record_of, run_campaign

    check_records(file)
    tell_campaign(len(grid), len(cases), workers)
    done: dict[str, bool] = {}
    with (
        show_progress("robustness", len(grid) + len(cases), "jobs") as bar,
        worker_pool(workers) as executor,
    ):

        def report(number: int) -> None:
            bar.n = number
            bar.refresh()

        def work() -> None:
            run_campaign(grid, file, executor, report, done)
            search_limits(
                cases,
                file,
                executor,
                lambda number: report(len(grid) + number),
                done,
            )

        return done, gather(
            work,
            file,
            lambda: {key: record_of(done[key]) for key in done},
        )
