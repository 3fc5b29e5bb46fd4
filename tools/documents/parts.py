"""Generated part of a document, with its expected text."""

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Part:
    """Stretch of a document's text.

    Attributes:
        start: Offset in the text.
        got: Current text.
        wanted: Expected text; None if unknown.
        source: Source of the part, as the document names it.
        problem: Why the expected text is unknown.
    """

    start: int
    got: str
    wanted: str | None
    source: str
    problem: str = ""

    def complaints(self, text: str) -> Iterator[str]:
        """Yield line, expected and current text if they differ."""
        line = text.count("\n", 0, self.start) + 1
        if self.wanted is None:
            yield f"{line}: {self.problem} ({self.source})"
            return
        if self.wanted == self.got:
            return
        wanted, got = self.wanted.split("\n"), self.got.split("\n")
        number = max(len(wanted), len(got))
        wanted += ["nothing"] * (number - len(wanted))
        got += ["nothing"] * (number - len(got))
        for i, (w, g) in enumerate(zip(wanted, got, strict=True)):
            if w != g:
                yield f"{line + i}: wanted {w!r}, got {g!r} ({self.source})"
                return
