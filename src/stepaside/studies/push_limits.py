"""Search for the largest push that a walk survives, by bisection."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from .robustness_trial import DIRECTIONS, RobustnessTrial, run_trial
from .tabulation import Record

# In [N s] for NAO; see :func:`.robustness_trial.push_scale`.
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


def search_limit(case: RobustnessTrial) -> Record:
    """Run trials until the largest push that a walk survives is known.

    Args:
        case: Trial with strength 0.

    Returns:
        ``strengths`` that were tried, in [N s] for NAO, and ``survived``,
        whether the walk survived each.
    """
    outcomes: dict[float, bool] = {}
    while (strength := next_strength(outcomes)) is not None:
        trial = replace(case, strength=strength)
        outcomes[strength] = run_trial(trial)["survived"]
    return {
        "strengths": list(outcomes),
        "survived": list(outcomes.values()),
    }


def outcomes_of(record: Record) -> dict[float, bool]:
    """Return the outcome of each strength that was tried."""
    return dict(zip(record["strengths"], record["survived"], strict=True))
