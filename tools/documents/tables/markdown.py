"""Tables and numbers in Markdown."""

from collections.abc import Iterable, Sequence

from stepaside.studies.survival import wilson

NONE = "-"  # stands where there is nothing to show


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table.

    Args:
        head: Titles of the columns.
        rows: Cells, as many in each row as there are titles.

    Raises:
        ValueError: If a row has another number of cells.
    """
    lines = [_line(head), "|" + "---|" * len(head)]
    for row in rows:
        if len(row) != len(head):
            raise ValueError(f"want {len(head)} cells {head}, got {row}")
        lines.append(_line(row))
    return "\n".join(lines)


def number(value: float | None, digits: int = 3) -> str:
    """A number with a fixed number of decimals; a dash for none."""
    return NONE if value is None else f"{value:.{digits}f}"


def interval(low: float | None, high: float | None, digits: int = 3) -> str:
    """From one number to another, or one where both are written alike."""
    ends = number(low, digits), number(high, digits)
    return ends[0] if ends[0] == ends[1] else f"{ends[0]}-{ends[1]}"


def counted(hits: int, of: int) -> str:
    """How many of a number, with the 95 % interval of the share (Wilson)."""
    low, high = wilson(hits, of)
    return f"{hits} ({interval(100.0 * low, 100.0 * high, 0)} %)"


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(c.replace("|", "\\|") for c in cells) + " |"
