"""How long work takes, said before it begins."""

import os

import click

from .terminal import echo

LONG = 60.0  # of which it is said, in [s]
ENDLESS = 30 * 86400.0  # which is refused, in [s]
# Rough figures of one core of a laptop; docs/benchmark.md has measured ones.
SIMULATED = 6.0  # seconds of a game in one second
STEPS = 2e7  # of unicycles in one second
PICTURES = 10.0  # of 640x480 in one second
CELLS = 2e7  # steps of a cell of a table in one second
HELD = 2500.0  # samples of a game with held rates in one second
DECISIONS = 500.0  # of two strategies in one second
SETTLED = 1000.0  # times 1/k of one exact game in one second


def tell_effort(what: str, seconds: float, workers: int | None = 1) -> None:
    """Say what will be computed and how long it takes, if that is long.

    Args:
        what: Will be computed, like ``1000 duels of 120 s``.
        seconds: It takes on one core, roughly.
        workers: Processes that share it; all cores if None.

    Raises:
        UsageError: If it would take longer than anybody waits.
    """
    seconds /= workers or os.cpu_count() or 1
    if seconds > ENDLESS:
        raise click.UsageError(
            f"{what} would take about {in_words(seconds)}; ask for what ends "
            f"within {in_words(ENDLESS)}"
        )
    if seconds > LONG:
        echo(
            f"stepaside: {what}, about {in_words(seconds)}; Ctrl-C stops",
            err=True,
        )


def in_words(seconds: float) -> str:
    """A time as people say it, to one or two digits."""
    for unit, length in (("days", 86400.0), ("hours", 3600.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.2g} {unit}"
    return f"{max(seconds / 60.0, 1.0):.2g} minutes"
