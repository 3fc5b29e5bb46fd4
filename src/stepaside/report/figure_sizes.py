"""Figure sizes: for a screen, a column or the width of a page."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple

from ..core.errors import ConfigurationError


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
def figures_on(name: str) -> Iterator[FigureSheet]:
    """Draw figures on one of ``SHEETS`` inside a ``with`` block.

    Args:
        name: "screen", "page" or "column".

    Raises:
        ConfigurationError: If there is no such sheet.
    """
    if name not in SHEETS:
        raise ConfigurationError(
            f"figure width must be one of {', '.join(SHEETS)}, got {name!r}"
        )
    token = _chosen.set(SHEETS[name])
    try:
        yield SHEETS[name]
    finally:
        _chosen.reset(token)
