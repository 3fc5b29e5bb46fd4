"""A part of a document that is made, and what it should be."""

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Part:
    """A stretch of a document's text.

    Attributes:
        start: Where it begins in the text.
        got: What stands there.
        wanted: What should stand there; None if that is unknown.
        source: What it is made from, as the document names it.
        problem: Why it is unknown what should stand there.
    """

    start: int
    got: str
    wanted: str | None
    source: str
    problem: str = ""

    def complaints(self, text: str) -> Iterator[str]:
        """Line, wanted and got of what is not as it should be.

        Args:
            text: Of the whole document.
        """
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
