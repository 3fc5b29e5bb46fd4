"""Printed tables of result entries."""

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any

from ..report.result_labels import in_unit, label_of, unit_of
from .terminal import echo

Row = Mapping[str, Any]


def plain(value: Any) -> Any:
    """Return a result as JSON has it.

    Dataclasses and named tuples become objects, NaN and infinity null, and
    complex numbers pairs.
    """
    if is_dataclass(value) and not isinstance(value, type):
        value = {f.name: getattr(value, f.name) for f in fields(value)}
    elif hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, Mapping):
        return {name: plain(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, complex):
        return [value.real, value.imag]
    if isinstance(value, float) and not isfinite(value):
        return None
    return value


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
    result: Row, names: Iterable[str], digits: int = 6
) -> list[tuple[str, str]]:
    """Return labels and formatted values of some entries of a result."""
    return [
        (label_of(name), format_value(name, result[name], digits))
        for name in names
    ]


def result_rows(result: Row, digits: int = 4) -> list[tuple[str, str]]:
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
        elif name.endswith("_per_s"):  # eigenvalues
            rows.append((label_of(name), format_value(name, value, digits)))
        elif not any(isinstance(each, Mapping | list) for each in value):
            texts = (format_value(name, each, digits) for each in value)
            rows.append((label_of(name), ", ".join(texts) or "none"))
    return rows


def print_rows(
    rows: Sequence[Row],
    names: Sequence[str],
    *,
    left: Container[int] = (),
    digits: int = 4,
) -> None:
    """Print some entries of each row in columns, below their labels."""
    cells = [
        [format_value(name, row.get(name), digits) for name in names]
        for row in rows
    ]
    print_columns([label_of(name) for name in names], cells, left=left)


def print_columns(
    heads: Sequence[str],
    rows: Iterable[Sequence[str]],
    *,
    left: Container[int],
) -> None:
    """Print one line per row, below a header, in aligned columns.

    The columns in ``left`` are aligned to the left.
    """
    table = [heads, *rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for line in table:
        cells = [
            cell.ljust(width) if k in left else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(line, widths, strict=True))
        ]
        echo("  ".join(cells).rstrip())


def print_table(rows: Sequence[tuple[str, str]]) -> None:
    """Print names and values in two columns."""
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        echo(f"  {name:<{width}}  {value}")
