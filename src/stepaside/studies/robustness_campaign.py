"""Campaign of walks under disturbances: one record per trial."""

from collections.abc import Sequence

from .campaign import Study, code_stamp
from .code_version import LIBRARIES
from .push_limits import search_limit
from .robustness_trial import RobustnessTrial, run_trial

MODULES = ("studies/push_limits",)  # which runs trials


def robustness_study(
    trials: Sequence[RobustnessTrial],
) -> Study[RobustnessTrial]:
    """Return the study of some trials."""
    return Study(
        "robustness",
        trials,
        run_trial,
        lambda trial: trial.key,
        lambda trial: code_stamp(MODULES, LIBRARIES),
        ("survived",),
    )


def push_study(cases: Sequence[RobustnessTrial]) -> Study[RobustnessTrial]:
    """Return the study of the largest push of some trials with strength 0."""
    return Study(
        "push limits",
        cases,
        search_limit,
        lambda case: case.key,
        lambda case: code_stamp(MODULES, LIBRARIES),
        ("strengths", "survived"),
    )
