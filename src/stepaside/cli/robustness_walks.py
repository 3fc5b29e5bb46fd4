"""``stepaside robustness``: simulated walks under disturbances."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .campaign_options import CampaignOptions
from .campaign_reports import run_campaign
from .progress import SIMULATED, announce_effort

if TYPE_CHECKING:
    from ..games.walk_settings import WalkSettings
    from ..studies.study import StudyRun

WALK = 20.0  # duration of a trial, in [s]
PUSHES = 8  # typical number of walks in the search for one push limit


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
    from ..studies.robustness_trial import trials

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


class WalkRuns(NamedTuple):
    """Results of the walks of a campaign.

    Attributes:
        trials: Run of the trials.
        limits: Run of the searches for push limits.
    """

    trials: "StudyRun[Any]"
    limits: "StudyRun[Any]"

    @property
    def last(self) -> "StudyRun[Any]":
        """The run that ended the campaign."""
        return self.limits if self.trials.completed else self.trials


def summarise_walks(
    settings: "WalkSettings", body: str, runs: WalkRuns
) -> dict[str, Any]:
    """Return the results so far, with planned and finished numbers.

    The number of walks in the search for push limits is not known ahead.
    """
    from ..studies.robustness_trial import mass_of, push_scale
    from ..studies.survival_statistics import (
        limit_rows,
        push_survival_rows,
        summarise_limits,
        survival_rows,
    )

    limits = limit_rows(runs.limits.items())
    scale = push_scale(settings.robot)
    return {
        "body": body,
        "robot": settings.robot,
        "mass_kg": mass_of(settings.robot),
        "planned": {
            "trials": runs.trials.total,
            "push_limits": runs.limits.total,
        },
        "done": {
            "trials": runs.trials.finished,
            "push_limits": runs.limits.finished,
            "push_walks": sum(
                len(record["strengths"]) for record in runs.limits.records()
            ),
        },
        "survival": survival_rows(runs.trials.items())
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
    from ..studies.robustness_trial import UNITS

    head = header(request.settings())
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
    grid: list[Any], cases: list[Any], campaign: CampaignOptions
) -> WalkRuns:
    """Run the trials and the searches for push limits, with progress."""
    from ..studies.robustness_campaign import push_study, robustness_study
    from ..studies.study import StudyRun

    walks = campaign.share(len(grid) + PUSHES * len(cases))
    announce_effort(
        f"about {walks} walks of {WALK:g} s, fewer if some are recorded",
        walks * WALK / SIMULATED,
        campaign.workers,
    )
    trials = run_campaign(robustness_study(grid), campaign, "walks")
    searches = push_study(cases)
    if trials.completed:
        return WalkRuns(trials, run_campaign(searches, campaign, "limits"))
    return WalkRuns(trials, StudyRun(searches))
