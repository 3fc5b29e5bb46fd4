"""Printed tables of result entries."""

from collections.abc import Container, Iterable, Mapping, Sequence
from typing import Any

from ..report.result_labels import in_unit, label_of, unit_of
from .terminal import echo


def format_value(name: str, value: Any, digits: int = 6) -> str:
    """Return a value with the unit of its name.

    Args:
        name: Name of the value.
        value: Value in the unit of the name; a list has pairs of real and
            imaginary parts.
        digits: Number of significant digits.
    """
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    unit = unit_of(name)
    if isinstance(value, list):
        pairs = [f"{re:.{digits}g}{im:+.{digits}g}i" for re, im in value]
        text = ", ".join(pairs)
    elif isinstance(value, Mapping):
        text = ", ".join(f"{one} by {other}" for one, other in value.items())
        return text or "none"
    elif isinstance(value, int | float):
        text = f"{in_unit(name, value):.{digits}g}"
    else:
        return str(value)
    return f"{text} {unit}".strip()


def table_rows(
    result: Mapping[str, Any], names: Iterable[str], digits: int = 6
) -> list[tuple[str, str]]:
    """Return labels and formatted values of some entries of a result."""
    return [
        (label_of(name), format_value(name, result[name], digits))
        for name in names
    ]


def scalar_rows(
    result: Mapping[str, Any], digits: int = 6
) -> list[tuple[str, str]]:
    """Return labels and values of the entries without entries of their own."""
    names = (n for n, v in result.items() if not isinstance(v, dict | list))
    return table_rows(result, names, digits)


def result_rows(
    result: Mapping[str, Any], digits: int = 4
) -> list[tuple[str, str]]:
    """Return labels and values of all entries, of inner ones as well.

    Tables in lists are left out.
    """
    rows = []
    for name, value in result.items():
        if isinstance(value, Mapping):
            inner = result_rows(value, digits)
            rows += [
                (f"{label_of(name)}: {each}", text) for each, text in inner
            ]
        elif not isinstance(value, list | tuple):
            rows.append((label_of(name), format_value(name, value, digits)))
        elif not any(isinstance(each, Mapping | list) for each in value):
            texts = (format_value(name, each, digits) for each in value)
            rows.append((label_of(name), ", ".join(texts) or "none"))
    return rows


def finite(value: float) -> float | None:
    """Return a value for JSON: None for NaN and infinity."""
    return value if abs(value) < float("inf") else None


def print_columns(
    heads: Sequence[str],
    rows: Iterable[Sequence[str]],
    *,
    left: Container[int],
    indent: str = "",
) -> None:
    """Print one line per row, below a header, in aligned columns.

    Args:
        heads: Heads of the columns.
        rows: Cells of each row.
        left: Columns that are aligned to the left.
        indent: Text before each line.
    """
    table = [heads, *rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for line in table:
        cells = [
            cell.ljust(width) if k in left else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(line, widths, strict=True))
        ]
        echo(indent + "  ".join(cells).rstrip())


def print_table(rows: list[tuple[str, str]]) -> None:
    """Print names and values in two columns."""
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        echo(f"  {name:<{width}}  {value}")
