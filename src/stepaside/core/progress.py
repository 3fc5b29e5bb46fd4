"""Progress of long work, on standard error."""

import sys
from time import monotonic

PERIOD = 10.0  # between two lines if standard error is not a terminal, in [s]
SHOWN_PERIOD = 0.1  # between two changes of the line on a terminal, in [s]


class ProgressLine:
    """Progress on standard error: one line that changes on a terminal.

    Elsewhere, or if ``quiet``, there is a line every few seconds. The total is
    None if not known yet; without unit it is a fraction of 1.
    """

    def __init__(
        self,
        name: str,
        total: float | None = None,
        unit: str = "",
        *,
        quiet: bool = False,
    ) -> None:
        """Start at zero."""
        self.n: float = 0  # finished work
        self._name, self._total, self._unit = name, total, unit
        self._text, self._reused = "", 0.0
        # Standard error may be closed.
        self._changes = bool(not quiet and sys.stderr and sys.stderr.isatty())
        self._began = self._printed = monotonic()
        self._first = self._began, 0.0  # time and work of the first report

    def __enter__(self) -> "ProgressLine":
        """Return the display; print nothing yet."""
        return self

    def __exit__(self, *error: object) -> None:
        """Leave the last line on a terminal."""
        if self._changes and self.n:
            self._print()
            print(file=sys.stderr, flush=True)

    def update(self, more: float = 1) -> None:
        """Add finished work."""
        self.show(self.n + more)

    def show(
        self,
        done: float,
        total: float | None = None,
        text: str = "",
        *,
        reused: float = 0.0,
    ) -> None:
        """Set the finished work, and the total if given.

        A line is printed if the last one is older than the period. Work that
        was reused took no time.
        """
        self.n, self._total = done, total or self._total
        self._text, self._reused = text, reused
        if self._first[1] == 0.0 < done - reused:
            self._first = monotonic(), done - reused
        period = SHOWN_PERIOD if self._changes else PERIOD
        if sys.stderr and monotonic() - self._printed >= period:
            self._print()

    def _print(self) -> None:
        done, total = self.n, self._total
        self._printed = monotonic()
        elapsed = self._printed - self._began
        words = [f"{done:.0f} {self._unit}".rstrip()]
        times = [f"{elapsed:.0f} s so far"]
        if total:
            words = [f"{100.0 * done / total:.0f} %"]
            if self._unit:
                words.append(f"{done:.0f} of {total:.0f} {self._unit}")
            fresh = done - self._reused
            # Before the first report it may be compiling.
            began, before = self._first
            if done < total and fresh > max(before, 0.05 * total):
                rest = (total - done) * (self._printed - began)
                rest /= fresh - before
                times.append(f"about {rest:.0f} s left")
        words += [self._text] if self._text else []
        line = f"stepaside: {self._name}: {', '.join(words)}; "
        line += ", ".join(times)
        # On a terminal it begins anew, and the rest of the line is erased.
        line = f"\r{line}\x1b[K" if self._changes else f"{line}\n"
        print(line, end="", file=sys.stderr, flush=True)
