"""Sizes of figures: on a screen, in a column, across a page."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple

from ..core.errors import ConfigurationError


class FigureSheet(NamedTuple):
    """How wide a figure is, and how its words are set.

    Attributes:
        width: Of the whole figure, in [inch]; as the figure wants if None.
        font: Size of its words, in [pt].
        family: Fonts, the first that is there.
        narrow: Whether what lies side by side should lie one below the other.
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
    """What figures are drawn on at present."""
    return _chosen.get()


@contextmanager
def figures_on(name: str) -> Iterator[FigureSheet]:
    """Draw figures on a sheet of one of ``SHEETS`` meanwhile.

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
