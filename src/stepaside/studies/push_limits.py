"""Search for the largest push that a walk survives, by bisection."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import replace
from pathlib import Path

from ..core.worker_pool import cancel_pending
from .robustness_campaign import (
    DIRECTIONS,
    RobustnessTrial,
    append_result,
    read_results,
    run_trial,
)

# In [N s] for NAO; see :func:`.robustness_campaign.push_scale`.
RESOLUTION = 0.1  # to which a limit is found
STRIDE = 0.4  # between pushes before bisection
LARGEST = 8.0


def push_cases(
    methods: Sequence[str],
    body: str,
    *,
    phases: int,
    seed: int = 1,
    changes: str = "",
) -> Iterator[RobustnessTrial]:
    """Yield a trial with strength 0 for each method, direction and phase."""
    for method in methods:
        for direction in DIRECTIONS:
            for i in range(phases):
                yield RobustnessTrial(
                    "push",
                    0.0,
                    direction,
                    i / phases,
                    seed,
                    method,
                    body,
                    changes,
                )


def limit_of(outcomes: Mapping[float, bool]) -> float:
    """Return the largest strength survived with all smaller ones tried."""
    failed = min((s for s, ok in outcomes.items() if not ok), default=None)
    return max(
        (
            s
            for s, ok in outcomes.items()
            if ok and (failed is None or s < failed)
        ),
        default=0.0,
    )


def next_strength(outcomes: Mapping[float, bool]) -> float | None:
    """Return the next strength to try, in [N s]; None once the limit is known.

    Pushes grow by a stride until one is not survived; then the interval
    below it is bisected. Strengths above the first failure are not tried.
    """
    limit = limit_of(outcomes)
    failed = min((s for s, ok in outcomes.items() if not ok), default=None)
    if failed is None:
        larger = limit + STRIDE
        return round(larger, 6) if larger <= LARGEST else None
    parts = round((failed - limit) / RESOLUTION)
    if parts <= 1:
        return None
    return round(limit + parts // 2 * RESOLUTION, 6)


def outcomes_of(
    cases: Sequence[RobustnessTrial], results: Mapping[str, bool]
) -> dict[RobustnessTrial, dict[float, bool]]:
    """Return the outcome of each strength that was tried, by case."""
    outcomes: dict[RobustnessTrial, dict[float, bool]] = {
        case: {} for case in cases
    }
    for key, survived in results.items():
        case, strength = _case_of(key)
        if case in outcomes:
            outcomes[case][strength] = survived
    return outcomes


def _case_of(key: str) -> tuple[RobustnessTrial, float]:
    """Return the case of a key, and its strength."""
    trial = RobustnessTrial(*json.loads(key))
    return replace(trial, strength=0.0), trial.strength


def search_limits(
    cases: Sequence[RobustnessTrial],
    file: Path | None,
    executor: Executor,
    report: Callable[[int], None] | None = None,
    done: dict[str, bool] | None = None,
) -> dict[str, bool]:
    """Run trials until the limit of every case is known.

    Args:
        cases: Trials with strength 0.
        file: Results so far, extended by each trial; None to store nothing.
            Results of other cases are ignored.
        executor: Any executor of ``concurrent.futures``.
        report: Called with the number of finished cases.
        done: Dictionary that receives the results as they arrive, and holds
            them if the campaign is interrupted.

    Returns:
        Whether each trial was survived, by key, including the entries of
        ``done``.
    """
    results: dict[str, bool] = {} if done is None else done
    requested = set(cases)
    results.update(
        (key, survived)
        for key, survived in read_results(file).items()
        if _case_of(key)[0] in requested
    )
    outcomes = outcomes_of(cases, results)
    running: dict[Future[tuple[str, bool]], tuple[RobustnessTrial, float]] = {}

    def start(case: RobustnessTrial) -> None:
        strength = next_strength(outcomes[case])
        if strength is not None:
            trial = replace(case, strength=strength)
            running[executor.submit(run_trial, trial)] = case, strength

    try:
        for case in cases:
            start(case)
        while running:
            if report is not None:
                report(len(cases) - len(running))
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                case, strength = running.pop(future)
                key, survived = future.result()
                results[key] = outcomes[case][strength] = survived
                append_result(file, key, survived)
                start(case)
    except BaseException:
        cancel_pending(executor, running)
        raise
    if report is not None:
        report(len(cases))
    return results
