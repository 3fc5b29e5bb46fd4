"""Announcement and progress of long work."""

import os
import sys
from time import monotonic
from types import TracebackType
from typing import Any

import click

from .terminal import echo

ANNOUNCED = 60.0  # work longer than this is announced, in [s]
LONGEST = 30 * 86400.0  # work longer than this is refused, in [s]
# Rough rates of one laptop core; docs/benchmark.md has measured ones.
SIMULATED = 6.0  # seconds simulated per second
STEPS = 1e7  # unicycle steps per second
IMAGES = 10.0  # images of 640x480 per second
CELLS = 2e7  # steps of one grid cell per second
SAMPLES = 2500.0  # samples of a game with sampled turning rates per second
DECISIONS = 500.0  # decisions of two strategies per second
TIME_CONSTANTS = 1000.0  # 1/k of an exactly integrated game per second
PERIOD = 10.0  # between two lines if standard error is not a terminal, in [s]


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


def show_progress(
    name: str,
    total: float | None = None,
    unit: str = "",
    *,
    bar_format: str | None = None,
    quiet: bool = False,
) -> Any:
    """Return a progress display on standard error.

    Args:
        name: Name of the work, one word.
        total: Size of the work, in its unit; None if not known yet.
        unit: Unit of the work; empty for a fraction of 1.
        bar_format: Format of the bar, for tqdm.
        quiet: Whether to print lines instead of a bar on a terminal, too.

    Returns:
        Context manager with ``n`` and ``total``, which may be set, and
        ``update``, ``refresh`` and ``set_postfix_str`` of a tqdm bar.
    """
    if quiet or not sys.stderr.isatty():
        return PlainProgress(name, total, unit)
    from tqdm import tqdm

    return tqdm(desc=name, total=total, unit=unit, bar_format=bar_format)


class PlainProgress:
    """Progress as one line every few seconds, for logs and pipes.

    Attributes:
        n: Finished work, in its unit.
        initial: Part of it that was finished before, and took no time.
        total: Total work; None if not known yet.
    """

    def __init__(self, name: str, total: float | None, unit: str) -> None:
        """Start at zero."""
        self.n: float = 0
        self.initial: float = 0
        self.total = total
        self._name, self._unit, self._postfix = name, unit, ""
        self._began = self._printed = monotonic()

    def __enter__(self) -> "PlainProgress":
        """Return the display; print nothing yet."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Print nothing: the result follows."""

    def update(self, more: float = 1) -> None:
        """Add finished work."""
        self.n += more
        self.refresh()

    def set_postfix_str(self, text: str) -> None:
        """Append a text to each line."""
        self._postfix = f", {text}"
        self.refresh()

    def refresh(self) -> None:
        """Print a line if the last one is older than the period."""
        now = monotonic()
        if now - self._printed < PERIOD:
            return
        self._printed = now
        elapsed = now - self._began
        done = f"{self.n:.0f}"
        remaining = ""
        if self.total:
            fraction = self.n / self.total
            done = f"{100.0 * fraction:.0f} %"
            if self._unit:
                done += f", {self.n:.0f} of {self.total:.0f} {self._unit}"
            if self.n > self.initial:
                pace = elapsed / (self.n - self.initial)
                seconds = pace * (self.total - self.n)
                remaining = f", about {seconds:.0f} s left"
        elif self._unit:
            done += f" {self._unit}"
        echo(
            f"stepaside: {self._name}: {done}{self._postfix}; "
            f"{elapsed:.0f} s so far{remaining}",
            err=True,
        )
