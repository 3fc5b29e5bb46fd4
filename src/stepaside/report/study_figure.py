"""Figure of a study: its first value over what varies."""

from collections.abc import Mapping, Sequence
from typing import Any

from .figure_style import plt, save

UNITS = {  # by the end of a name
    "_rad_s": "rad/s",
    "_n_s": "N s",
    "_m_s": "m/s",
    "_deg": "deg",
    "_m2": "m^2",
    "_m": "m",
    "_s": "s",
}


def draw_study(
    rows: Sequence[Mapping[str, Any]], by: Sequence[str], path: str
) -> None:
    """Draw means or shares with 95 % intervals.

    The axis is the first numeric value of ``by``, else the last one; there
    is a line for each combination of the others.

    Args:
        rows: Rows of :func:`stepaside.studies.tabulation.tabulate`.
        by: Names of the groups.
        path: File to write; its suffix gives the format.
    """
    (value, *_) = [n for n in rows[0] if n not in (*by, "number")]
    numeric = [n for n in by if isinstance(rows[0][n], int | float)]
    axis = (numeric or list(by[-1:]) or ["number"])[0]
    lines: dict[str, list[tuple[Any, float, float, float]]] = {}
    for row in rows:
        name = ", ".join(str(row[n]) for n in by if n != axis)
        if (point := _point(row[value])) is not None:
            at = row[axis] if numeric else str(row[axis])
            lines.setdefault(name, []).append((at, *point))
    figure, ax = plt.subplots(figsize=(6.4, 3.8))
    for name, points in lines.items():
        at, middle, below, above = zip(*points, strict=True)
        style = "o-" if numeric else "o"
        ax.errorbar(
            at, middle, (below, above), fmt=style, capsize=3, label=name
        )
    ax.set_xlabel(_label(axis))
    shares = any(row[value] and "mean" not in row[value] for row in rows)
    ax.set_ylabel(f"{value} [%]" if shares else _label(value))
    if len(lines) > 1:
        ax.legend()
    save(figure, path)


def _label(name: str) -> str:
    """Return a name with its unit, which its end tells."""
    for end, unit in UNITS.items():
        if name.endswith(end):
            return f"{name.removesuffix(end).replace('_', ' ')} [{unit}]"
    return name.replace("_", " ")


def _point(found: Any) -> tuple[float, float, float] | None:
    """Return the middle and both ends of the interval of a value."""
    if found is None:
        return None
    if "mean" in found:
        return found["mean"], found["half"], found["half"]
    if "share" not in found:  # of a text: the share of its first value
        found = next(iter(found.values()))
    share, low, high = (100.0 * found[n] for n in ("share", "low", "high"))
    return share, share - low, high - share
