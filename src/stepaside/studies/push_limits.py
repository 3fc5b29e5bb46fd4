"""The largest push that a walk survives, found by halving."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import replace
from pathlib import Path

from ..core.worker_pool import give_up
from .robustness_campaign import (
    DIRECTIONS,
    RobustnessTrial,
    note_result,
    read_results,
    run_trial,
)

# In [N s] for NAO; see :func:`.robustness.push_scale`.
RESOLUTION = 0.1  # to which a limit is found
STRIDE = 0.4  # between the first pushes tried
LARGEST = 8.0  # push that is tried


def push_cases(
    methods: Sequence[str],
    body: str,
    *,
    phases: int,
    seed: int = 1,
    changes: str = "",
) -> Iterator[RobustnessTrial]:
    """One trial of no strength for each method, direction and phase."""
    for method in methods:
        for direction in DIRECTIONS:
            for i in range(phases):
                yield RobustnessTrial(
                    *("push", 0.0, direction, i / phases, seed, method, body),
                    changes,
                )


def limit_of(outcomes: Mapping[float, bool]) -> float:
    """Largest strength survived together with all smaller ones tried."""
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
    """What to try next, in [N s]; None once the limit is known.

    Pushes grow by a stride until one is not survived; then the gap below it
    is halved. So what lies above the first failure is not tried.
    """
    limit = limit_of(outcomes)
    failed = min((s for s, ok in outcomes.items() if not ok), default=None)
    if failed is None:
        wanted = limit + STRIDE
        return round(wanted, 6) if wanted <= LARGEST else None
    parts = round((failed - limit) / RESOLUTION)
    if parts <= 1:
        return None
    return round(limit + parts // 2 * RESOLUTION, 6)


def outcomes_of(
    cases: Sequence[RobustnessTrial], results: Mapping[str, bool]
) -> dict[RobustnessTrial, dict[float, bool]]:
    """Whether each strength that was tried was survived, by case."""
    outcomes: dict[RobustnessTrial, dict[float, bool]] = {
        case: {} for case in cases
    }
    for key, survived in results.items():
        case, strength = _case_of(key)
        if case in outcomes:
            outcomes[case][strength] = survived
    return outcomes


def _case_of(key: str) -> tuple[RobustnessTrial, float]:
    """Trial of no strength that a key belongs to, and its strength."""
    trial = RobustnessTrial(*json.loads(key))
    return replace(trial, strength=0.0), trial.strength


def search_limits(
    cases: Sequence[RobustnessTrial],
    file: Path | None,
    executor: Executor,
    report: Callable[[int], None] | None = None,
    done: dict[str, bool] | None = None,
) -> dict[str, bool]:
    """Walk until the limit of every case is known.

    Args:
        cases: Trials of no strength.
        file: Results that are done, which grows; None keeps nothing. Those
            of other cases are left out.
        executor: Any executor of ``concurrent.futures``.
        report: Called with the number of cases that are done.
        done: Filled with the results as they come, for whoever stops it.

    Returns:
        Whether each trial of the cases was survived, by key, beside what
        was in ``done``.
    """
    results: dict[str, bool] = {} if done is None else done
    asked = set(cases)
    results.update(
        (key, survived)
        for key, survived in read_results(file).items()
        if _case_of(key)[0] in asked
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
                note_result(file, key, survived)
                start(case)
    except BaseException:
        give_up(executor, running)
        raise
    if report is not None:
        report(len(cases))
    return results
