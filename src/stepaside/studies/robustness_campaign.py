"""Campaign of walks under disturbances: one record per trial."""

from collections.abc import Sequence

from .push_limits import search_limit
from .robustness_trial import RobustnessTrial, run_trial
from .study import Study


def robustness_study(
    trials: Sequence[RobustnessTrial],
) -> Study[RobustnessTrial]:
    """Return the study of some trials."""
    return Study(
        "walks",
        trials,
        run_trial,
        lambda trial: trial.key,
    )


def push_study(cases: Sequence[RobustnessTrial]) -> Study[RobustnessTrial]:
    """Return the study of the largest push of some trials with strength 0."""
    return Study(
        "limits",
        cases,
        search_limit,
        lambda case: case.key,
    )
