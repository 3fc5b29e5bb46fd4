"""Tables and numbers in Markdown."""

from collections.abc import Iterable, Sequence

from stepaside.studies.tabulation import wilson_interval

NONE = "-"  # shown for missing values


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table.

    Args:
        head: Column headers.
        rows: Cells, one per column in each row.

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
    """Return a number with fixed decimals; a dash for None."""
    return NONE if value is None else f"{value:.{digits}f}"


def interval(low: float | None, high: float | None, digits: int = 3) -> str:
    """Return a range; one number if both ends look the same."""
    ends = number(low, digits), number(high, digits)
    return ends[0] if ends[0] == ends[1] else f"{ends[0]}-{ends[1]}"


def counted(hits: int, of: int) -> str:
    """Return a proportion with its 95 % Wilson interval."""
    low, high = wilson_interval(hits, of)
    return f"{hits} ({interval(100.0 * low, 100.0 * high, 0)} %)"


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(c.replace("|", "\\|") for c in cells) + " |"
