"""Figures of studies: values over what varies, and their distributions."""

from collections.abc import Iterable, Mapping, Sequence
from string import ascii_letters as LETTERS
from typing import Any, NamedTuple

from matplotlib.transforms import ScaledTranslation

from ..core.errors import AnyPath
from ..core.setting import entries_of
from ..games.game_settings import GameSettings
from ..games.player_settings import PlayerSettings
from ..locomotion.policy.velocity_response import AXES, VelocityResponse
from .figure_style import (
    LIGHT,
    THEORY,
    legend_below,
    panels,
    save,
)
from .result_labels import in_unit, label_of

MOST_COLUMNS = 4  # of panels in a row
MARKERS = "osD^vPX"
Rows = Sequence[Mapping[str, Any]]


class Curve(NamedTuple):
    """Values over a variable.

    Points are (x, y), or (x, y, below, above) with the ends of an interval
    relative to y.
    """

    label: str
    points: Iterable[Sequence[Any]]
    look: Mapping[str, Any] = {}  # arguments of Matplotlib's plots


def draw_curves(
    shown: Mapping[str, Sequence[Curve]],
    x: str | Sequence[str],
    y: str,
    file: AnyPath,
    *,
    size: tuple[float, float] = (2.9, 1.9),
) -> None:
    """Draw a panel of curves for each title, with one scale of y.

    The size is that of a panel, in [inch].
    """
    count = len(shown)
    columns = min(MOST_COLUMNS, count)
    letters = LETTERS[:count].ljust(-(-count // columns) * columns, ".")
    rows = [letters[i : i + columns] for i in range(0, len(letters), columns)]
    names = list(dict.fromkeys(c.label for cs in shown.values() for c in cs))
    across = 1 if columns < 2 else 3
    figure, axes = panels(
        rows,
        max(columns * size[0] + 0.8, 4.0),
        [size[1]] * len(rows),
        legend=-(-len(names) // across) if any(names) else 0,
        sharey=True,
    )
    labels = [x] * count if isinstance(x, str) else x
    for number, (title, curves) in enumerate(shown.items()):
        axis = axes[LETTERS[number]]
        for i, curve in enumerate(curves):
            beside = 5.0 * (i - 0.5 * (len(curves) - 1))
            colour, marker = LIGHT.others[i % 5], MARKERS[i % 7]
            _draw_curve(axis, curve, colour, marker, beside)
        axis.set(title=title, xlabel=labels[number])
        if number % columns == 0:
            axis.set_ylabel(y)
    if any(names):
        legend_below(figure, axes.values(), ncols=across)
    save(figure, file)


def _draw_curve(
    axis: Any, curve: Curve, colour: str, marker: str, beside: float
) -> None:
    """Draw a curve, with bars where its points have intervals.

    Those stand beside their place, in [pt], so that bars of several curves do
    not cover each other.
    """
    points = [tuple(point) for point in curve.points]
    look = {"color": colour, "marker": marker, "ms": 4.0, "lw": 1.2}
    look |= {"label": curve.label} | dict(curve.look)
    if not points:
        return
    if len(points[0]) == 2:
        axis.plot(*zip(*points, strict=True), **look)
        return
    at, middle, below, above = zip(*points, strict=True)
    drawn = axis.errorbar(at, middle, (below, above), capsize=3, **look)
    shift = ScaledTranslation(beside / 72.0, 0.0, axis.figure.dpi_scale_trans)
    for artist in drawn.get_children():
        artist.set_transform(axis.transData + shift)
    if isinstance(at[0], str):
        axis.margins(x=0.5 / max(len(at) - 1, 1))


def draw_study(rows: Rows, by: Sequence[str], path: AnyPath) -> None:
    """Draw means, or shares of true or of the first text, with intervals.

    The axis is the first numeric value of ``by``, else the last one; there
    is a line for each combination of the others. Rows are those of
    :func:`stepaside.studies.tabulation.tabulate`.
    """
    (value, *_) = [n for n in rows[0] if n not in (*by, "number")]
    numeric = [n for n in by if isinstance(rows[0][n], int | float)]
    axis = (numeric or list(by[-1:]) or ["number"])[0]
    lines: dict[str, list[tuple[Any, float, float, float]]] = {}
    found = [row[value] for row in rows if row[value]]
    shares = any("mean" not in each for each in found)
    text = next(iter(found[0])) if shares and "share" not in found[0] else ""
    for row in rows:
        name = ", ".join(str(row[n]) for n in by if n != axis)
        if (point := _point(value, row, text)) is not None:
            at = in_unit(axis, row[axis]) if numeric else str(row[axis])
            lines.setdefault(name, []).append((at, *point))
    look = {} if numeric else {"ls": "none"}
    curves = [Curve(name, points, look) for name, points in lines.items()]
    share = f"{text or label_of(value)} [%]"
    y = share if shares else label_of(value, unit=True)
    x = _label_of_axis(axis)
    names = "" if numeric else "".join({str(row[axis]) for row in rows})
    size = max(5.4, 0.09 * len(names)), 3.0  # names stand side by side
    sizes = {row["number"] for row in rows}
    games = "-".join(f"{n}" for n in sorted({min(sizes), max(sizes)}))
    has_bars = any(any(ends) for x in lines.values() for _, _, *ends in x)
    title = f"95 % intervals over {games} games" if has_bars else ""
    draw_curves({title: curves}, x, y, path, size=size)


def _label_of_axis(name: str) -> str:
    """Return the label of a value or a setting, with its unit."""
    label = label_of(name, unit=True)
    for path in (name, name.partition(".")[2]):
        for kind in (GameSettings, PlayerSettings):
            entry = entries_of(kind).get(path)
            if entry and (range := entry.described.range) and not range.whole:
                return f"{label} [{range.unit}]"
    return label


def _point(
    name: str, row: Mapping[str, Any], text: str
) -> tuple[float, float, float] | None:
    """Return the middle of a value, and how far its interval extends."""
    if (found := row[name]) is None:
        return None
    if "mean" in found:
        mean, half = found["mean"], found["half"] or 0.0
        mean, half = in_unit(name, mean), in_unit(name, half)
        return mean, half, half
    if text:
        none = 3.8415 / (row["number"] + 3.8415)  # Wilson's, for no record
        found = found.get(text, {"share": 0.0, "low": 0.0, "high": none})
    share, low, high = (100.0 * found[n] for n in ("share", "low", "high"))
    return share, share - low, high - share


def draw_response(response: VelocityResponse, file: AnyPath) -> None:
    """Draw the delivered velocities of learned legs over commands."""
    labels = ("forward [m/s]", "lateral [m/s]", "turn [rad/s]")
    shown = {}
    for i, axis in enumerate(response.axes):
        ends = [(x, x) for x in (axis.commands[0], axis.commands[-1])]
        even = {"color": THEORY, "marker": "", "ls": "--", "lw": 0.8}
        curves = [
            Curve(
                label,
                zip(axis.commands, column, strict=True),
                {"lw": 1.4 if k == i else 0.6},
            )
            for k, (label, column) in enumerate(
                zip(labels, zip(*axis.delivered, strict=True), strict=True)
            )
        ]
        shown[f"{AXES[i]}, lag {axis.lag:.2f} s"] = [
            *curves,
            Curve("as commanded", ends, even),
        ]
    x = [f"command {label}" for label in labels]
    draw_curves(shown, x, "delivered", file)
