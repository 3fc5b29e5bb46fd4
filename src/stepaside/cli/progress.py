"""Announcement of long work."""

import os

import click

from ..core.progress import show_progress as show_progress
from .terminal import echo

ANNOUNCED = 60.0  # work longer than this is announced, in [s]
LONGEST = 30 * 86400.0  # work longer than this is refused, in [s]
# Rough rates of one laptop core; docs/benchmark.md has measured ones.
SIMULATED = 6.0  # seconds simulated per second
STEPS = 1e7  # unicycle steps per second
IMAGES = 10.0  # images of 640x480 per second
CELLS = 1e6  # steps of one grid cell per second
SAMPLES = 2500.0  # samples of a game with sampled turning rates per second
DECISIONS = 500.0  # decisions of two strategies per second
TIME_CONSTANTS = 1000.0  # 1/k of an exactly integrated game per second


def announce_effort(
    work: str, seconds: float, workers: int | None = 1
) -> None:
    """Print what will be computed and for how long, if that is long.

    Args:
        work: What will be computed, like ``1000 duels of 120 s``.
        seconds: Estimated time on one core, in [s].
        workers: Number of processes; all cores if None.

    Raises:
        UsageError: If the work would take more than 30 days.
    """
    seconds /= workers or os.cpu_count() or 1
    if seconds > LONGEST:
        raise click.UsageError(
            f"{work} would take about {duration_text(seconds)}; the limit is "
            f"{duration_text(LONGEST)}"
        )
    if seconds > ANNOUNCED:
        echo(
            f"stepaside: {work}, about {duration_text(seconds)}; press "
            "Ctrl-C to stop",
            err=True,
        )


def duration_text(seconds: float) -> str:
    """Return a duration in days, hours or minutes, to two digits."""
    for unit, length in (("days", 86400.0), ("hours", 3600.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.2g} {unit}"
    return f"{max(seconds / 60.0, 1.0):.2g} minutes"
