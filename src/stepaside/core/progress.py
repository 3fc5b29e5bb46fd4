"""Progress of long work, on standard error."""

import sys
from collections.abc import Callable
from time import monotonic
from typing import Any

PERIOD = 10.0  # between two lines if standard error is not a terminal, in [s]


def show_progress(
    name: str,
    total: float | None = None,
    unit: str = "",
    *,
    bar_format: str | None = None,
    quiet: bool = False,
) -> Any:
    """Return a progress display on standard error, as a context manager.

    It is a bar of tqdm on a terminal, unless ``quiet``, and else prints lines.
    The total is None if not known yet; without unit it is a fraction of 1.
    """
    if quiet or not sys.stderr.isatty():
        return PlainProgress(name, total, unit)
    from tqdm import tqdm

    return tqdm(desc=name, total=total, unit=unit, bar_format=bar_format)


def counter(bar: Any) -> Callable[[int, int], None]:
    """Return a function that shows on a bar what is done of a number."""

    def report(done: int, number: int) -> None:
        bar.total, bar.n = number, done
        bar.refresh()

    return report


class PlainProgress:
    """Progress as one line every few seconds, for logs and pipes."""

    def __init__(self, name: str, total: float | None, unit: str) -> None:
        """Start at zero."""
        self.n: float = 0  # finished work
        self.initial: float = 0  # part finished before, which took no time
        self.total = total
        self._name, self._unit, self._postfix = name, unit, ""
        self._began = self._printed = monotonic()

    def __enter__(self) -> "PlainProgress":
        """Return the display; print nothing yet."""
        return self

    def __exit__(self, *error: object) -> None:
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
        done = f"{self.n:.0f} {self._unit}".rstrip()
        remaining = ""
        if self.total:
            done = f"{100.0 * self.n / self.total:.0f} %"
            if self._unit:
                done += f", {self.n:.0f} of {self.total:.0f} {self._unit}"
            if self.n > self.initial:
                pace = elapsed / (self.n - self.initial)
                seconds = pace * (self.total - self.n)
                remaining = f", about {seconds:.0f} s left"
        print(
            f"stepaside: {self._name}: {done}{self._postfix}; "
            f"{elapsed:.0f} s so far{remaining}",
            file=sys.stderr,
            flush=True,
        )
