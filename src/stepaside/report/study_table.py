"""Tables of studies as text: shares and means with their intervals."""

from collections.abc import Container, Iterable, Mapping, Sequence
from math import floor, log10
from typing import Any

from .result_labels import in_unit, label_of

MOST_DECIMALS = 6


def study_table(
    rows: Sequence[Mapping[str, Any]], by: Sequence[str], values: Sequence[str]
) -> str:
    """Return a line for each group, or one for each value of a single group.

    Rows are those of :func:`stepaside.studies.tabulation.tabulate`.
    """
    decimals = {name: _decimals(name, rows) for name in values}
    lines = [
        [
            *(_text(row[name]) for name in by),
            str(row["number"]),
            *(_cell(name, row[name], decimals[name]) for name in values),
        ]
        for row in rows
    ]
    heads = (*by, "games", *(label_of(name, unit=True) for name in values))
    if len(rows) != 1:
        return "\n".join(align_columns(heads, lines, left=range(len(by))))
    width = max(map(len, heads))
    return "\n".join(
        f"  {head:<{width}}  {cell}"
        for head, cell in zip(heads, lines[0], strict=True)
    )


def align_columns(
    heads: Sequence[str],
    rows: Iterable[Sequence[str]],
    *,
    left: Container[int],
) -> list[str]:
    """Return a header and a line for each row, in aligned columns.

    The columns in ``left`` are aligned to the left.
    """
    table = [heads, *rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = []
    for line in table:
        cells = [
            cell.ljust(width) if k in left else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(line, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    return lines


def _decimals(name: str, rows: Sequence[Mapping[str, Any]]) -> int:
    """Return decimals for a column: four digits of its greatest mean.

    More where the least mean would have fewer than two.
    """
    found = [row[name] for row in rows if row[name] and "mean" in row[name]]
    means = [abs(in_unit(name, each["mean"])) for each in found]
    sizes = [floor(log10(mean)) for mean in means if mean]
    if not sizes:
        return 0
    wanted = max(3 - max(sizes), 1 - min(sizes))
    return min(max(wanted, 0), MOST_DECIMALS)


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _cell(name: str, found: Any, decimals: int) -> str:
    """Return the statistics of a value as text, in the unit of its name."""
    if found is None:
        return "-"
    if "mean" in found:
        mean, half = in_unit(name, found["mean"]), found["half"]
        text = f"{mean:.{decimals}f}"
        if half:
            text += f" ±{in_unit(name, half):.{decimals}f}"
        return text
    if "share" in found:
        low, high = 100 * found["low"], 100 * found["high"]
        return f"{100 * found['share']:.0f} % ({low:.0f}-{high:.0f})"
    return ", ".join(f"{each['count']} {text}" for text, each in found.items())
