"""How far a command is: a bar on a terminal, else a line now and then."""

import sys
from time import monotonic
from types import TracebackType
from typing import Any

from .terminal import echo

PERIOD = 10.0  # between two lines where standard error is no terminal, in [s]


def show_progress(
    what: str,
    total: float | None = None,
    unit: str = "",
    *,
    form: str | None = None,
    quiet: bool = False,
) -> Any:
    """Begin to show how far some work is, on standard error.

    Args:
        what: Is being done, in a word.
        total: Size of the work, in its unit; None if it is not known yet.
        unit: Of the work; empty for a share of 1.
        form: Of the bar, as tqdm writes it.
        quiet: Whether there is no bar on a terminal either, but lines.

    Returns:
        Context manager with ``n`` and ``total``, which may be set, and
        ``update``, ``refresh`` and ``set_postfix_str`` of a tqdm bar.
    """
    if quiet or not sys.stderr.isatty():
        return PlainProgress(what, total, unit)
    from tqdm import tqdm

    return tqdm(desc=what, total=total, unit=unit, bar_format=form)


class PlainProgress:
    """Writes a line every some seconds, for logs and pipes.

    Attributes:
        n: Work that is done, in its unit.
        total: All of it; None if it is not known yet.
    """

    def __init__(self, what: str, total: float | None, unit: str) -> None:
        """Begin at nothing done."""
        self.n: float = 0
        self.total = total
        self._what, self._unit, self._aside = what, unit, ""
        self._began = self._said = monotonic()

    def __enter__(self) -> "PlainProgress":
        """Nothing is written yet."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """What came out says that it is done."""

    def update(self, more: float = 1) -> None:
        """Count work that was done."""
        self.n += more
        self.refresh()

    def set_postfix_str(self, text: str) -> None:
        """Say something else beside how far it is."""
        self._aside = f", {text}"
        self.refresh()

    def refresh(self) -> None:
        """Write a line, if the last one was some seconds ago."""
        now = monotonic()
        if now - self._said < PERIOD:
            return
        self._said = now
        spent = now - self._began
        far = f"{self.n:.0f}"
        left = ""
        if self.total:
            share = self.n / self.total
            far = f"{100.0 * share:.0f} %"
            if self._unit:
                far += f", {self.n:.0f} of {self.total:.0f} {self._unit}"
            if share > 0.0:
                left = f", about {spent * (1.0 / share - 1.0):.0f} s left"
        elif self._unit:
            far += f" {self._unit}"
        echo(
            f"stepaside: {self._what}: {far}{self._aside}; "
            f"{spent:.0f} s so far{left}",
            err=True,
        )
