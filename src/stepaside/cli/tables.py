"""Printed tables: labels, units and values of result entries."""

from collections.abc import Container, Iterable, Mapping, Sequence
from math import degrees
from typing import Any

from .terminal import echo

# Units by suffix of a name; the longest match counts. Angles are shown in
# degrees.
UNITS = {
    "_per_s": "1/s",
    "_rad_s": "rad/s",
    "_n_s": "N s",
    "_m_s": "m/s",
    "_rad": "deg",
    "_deg": "deg",
    "_hz": "Hz",
    "_share": "%",
    "_m2": "m^2",
    "_kg": "kg",
    "_m": "m",
    "_s": "s",
}
# Labels of names that are not clear by themselves.
LABELS = {
    "angle_rad": "evasion angle",
    "bearing_rad": "bearing of the pursuer",
    "body_radius_m": "radius of a body",
    "capture_m": "capture distance",
    "captured_share": "games captured",
    "closed": "closed walls",
    "closest_distance_m": "closest approach",
    "coupled": "coupled joints",
    "end_time_s": "final time",
    "eigenvalues_per_s": "eigenvalues",
    "evader_error_rad": "heading error of the evader",
    "exists": "circle exists",
    "falling_m": "decrease of a value in the last period, at most",
    "floor_m2": "floor area",
    "floor_used_evader_m": "maximum distance of the evader from its start",
    "free_for_body_m2": "floor area free for the centre of a body",
    "free_m2": "floor area without obstacles",
    "headings_apart_rad": "angle between headings",
    "mean_closest_distance_m": "mean closest approach",
    "min_distance_m": "closest approach",
    "min_zmp_margin_m": "minimum ZMP margin",
    "motions_apart_rad": "angle between motions",
    "pursuer_error_rad": "heading error of the pursuer",
    "radius_evader_m": "evader's radius",
    "radius_pursuer_m": "pursuer's radius",
    "relative_orientation_deg": "angle between headings",
    "settled_share": "games settled",
    "settled_time_largest_s": "maximum settling time",
    "settled_time_median_s": "median settling time",
    "seconds_s": "solver time",
    "sliding": "evader slides at zero error",
    "unsettled_share": "games not settled",
}


def unit_of(name: str) -> str:
    """Return the unit of a name by its suffix; empty if it has none."""
    return UNITS.get(_unit_suffix(name), "")


def _unit_suffix(name: str) -> str:
    suffixes = (suffix for suffix in UNITS if name.endswith(suffix))
    return max(suffixes, key=len, default="")


def label_of(name: str, *, unit: bool = False) -> str:
    """Return the label of a result entry.

    Args:
        name: Name like ``closest_distance_m``.
        unit: Whether to append the unit in brackets.
    """
    label = LABELS.get(name) or name.removesuffix(_unit_suffix(name))
    label = label.replace("_", " ")
    symbol = unit_of(name)
    return f"{label} [{symbol}]" if unit and symbol else label


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
        if name.endswith("_rad"):
            value = degrees(value)
        elif unit == "%":
            value = 100.0 * value
        text = f"{value:.{digits}g}"
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
    left: Container[int] = (0,),
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
