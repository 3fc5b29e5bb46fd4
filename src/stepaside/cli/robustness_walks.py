"""``stepaside robustness``: simulated walks under disturbances."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .campaign_reports import (
    CampaignOutcome,
    announce_campaign,
    check_records,
    run_campaign_work,
)
from .progress import show_progress

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings


class CampaignRequest(NamedTuple):
    """Settings of a campaign, named as the options of the command."""

    kinds: tuple[str, ...]
    methods: tuple[str, ...]
    body: str
    phases: int
    seeds: int
    seed: int
    changes: str = ""

    def settings(self) -> dict[str, Any]:
        """Return the settings for a result, without empty changes."""
        return {k: v for k, v in self._asdict().items() if v != ""}


def plan_walks(request: CampaignRequest) -> tuple[list[Any], list[Any]]:
    """Return all trials, and the push cases whose limit is searched."""
    from ..studies.push_limits import push_cases
    from ..studies.robustness_campaign import trials

    grid = trials(
        request.kinds,
        request.methods,
        request.body,
        seeds=request.seeds,
        first_seed=request.seed,
        changes=request.changes,
    )
    if "push" not in request.kinds:
        return list(grid), []
    cases = push_cases(
        request.methods,
        request.body,
        phases=request.phases,
        seed=request.seed,
        changes=request.changes,
    )
    return list(grid), list(cases)


def summarise_walks(
    settings: "WalkSettings",
    body: str,
    grid: list[Any],
    cases: list[Any],
    results: dict[str, bool],
) -> dict[str, Any]:
    """Return the results so far, with planned and finished numbers.

    The number of walks in the search for push limits is not known ahead.
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
    request: CampaignRequest,
    answer: dict[str, Any],
) -> None:
    """Write the results of a complete campaign, each file atomically."""
    from ..report.robustness_figure import draw_limits, draw_survival
    from ..studies.push_results import pushes_result
    from ..studies.result_files import header, write_result
    from ..studies.robustness_campaign import MODULES, UNITS

    head = header(request.settings(), modules=MODULES)
    write_result(output / "survival.json", head, **answer)
    draw_survival(answer["survival"], UNITS, output / "survival.png")
    limits = answer["limits"]
    if limits:
        draw_limits(limits, output / "limits.png")
        made = pushes_result(
            limits,
            request.methods,
            request.body,
            phases=request.phases,
            seed=request.seed,
            walk=settings,
        )
        write_result(output / "pushes.json", made)


def run_walks(
    grid: list[Any], cases: list[Any], file: Path | None, workers: int | None
) -> tuple[dict[str, bool], CampaignOutcome]:
    """Run the walks with a progress bar; return survival and outcome."""
    from ..core.worker_pool import worker_pool
    from ..studies.push_limits import search_limits
    from ..studies.robustness_campaign import record_of, run_campaign

    check_records(file)
    announce_campaign(len(grid), len(cases), workers)
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

        return done, run_campaign_work(
            work,
            file,
            lambda: {key: record_of(done[key]) for key in done},
        )
