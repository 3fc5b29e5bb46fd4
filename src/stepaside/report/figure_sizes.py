"""Figure sizes: for a screen, a column or the width of a page."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple


class FigureSheet(NamedTuple):
    """Width and typography of figures.

    Attributes:
        width: Of the whole figure, in [inch]; None for each figure's own.
        font: Font size, in [pt].
        family: Font families; the first that is installed is used.
        narrow: Whether panels are stacked instead of side by side.
    """

    width: float | None
    font: float
    family: tuple[str, ...]
    narrow: bool


SANS, SERIF = ("DejaVu Sans",), ("STIXGeneral", "DejaVu Serif")
# Widths of the two-column format of IEEE's transactions.
SHEETS = {
    "screen": FigureSheet(None, 9.0, SANS, narrow=False),
    "page": FigureSheet(7.16, 8.0, SERIF, narrow=False),
    "column": FigureSheet(3.5, 7.0, SERIF, narrow=True),
}
_chosen: ContextVar[FigureSheet] = ContextVar(
    "sheet", default=SHEETS["screen"]
)


def sheet() -> FigureSheet:
    """Return the sheet on which figures are drawn at present."""
    return _chosen.get()


@contextmanager
def figures_on(name: str) -> Iterator[None]:
    """Draw figures on one of ``SHEETS`` inside a ``with`` block.

    Args:
        name: "screen", "page" or "column".
    """
    token = _chosen.set(SHEETS[name])
    try:
        yield
    finally:
        _chosen.reset(token)
