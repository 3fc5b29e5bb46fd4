"""Figures of studies: values over what varies, and their distributions."""

from collections.abc import Iterable, Mapping, Sequence
from string import ascii_letters as LETTERS
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import AnyPath
from ..locomotion.policy.velocity_response import AXES, VelocityResponse
from .figure_style import (
    COLOURS,
    LEFT,
    LIGHT,
    LINES,
    RIGHT,
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

    Attributes:
        label: Name in the legend.
        points: Rows (x, y), or (x, y, below, above) with the ends of an
            interval relative to y.
        look: Arguments of Matplotlib's plots.
    """

    label: str
    points: Iterable[Sequence[Any]]
    look: Mapping[str, Any] = {}


def draw_curves(
    shown: Mapping[str, Sequence[Curve]],
    x: str | Sequence[str],
    y: str,
    file: AnyPath,
    *,
    size: tuple[float, float] = (2.9, 1.9),
) -> None:
    """Draw a panel of curves for each title, with one scale of y.

    Args:
        shown: Curves of each panel by its title.
        x: Label of the axes to the right, or of each.
        y: Label of the axes upward.
        file: Figure to write.
        size: Width and height of a panel, in [inch].
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
            _draw_curve(axis, curve, LIGHT.others[i % 5], MARKERS[i % 7])
        axis.set(title=title, xlabel=labels[number])
        if number % columns == 0:
            axis.set_ylabel(y)
    if any(names):
        legend_below(figure, axes.values(), ncols=across)
    save(figure, file)


def _draw_curve(axis: Any, curve: Curve, colour: str, marker: str) -> None:
    """Draw a curve, with bars where its points have intervals."""
    points = [tuple(point) for point in curve.points]
    look = {"color": colour, "marker": marker, "ms": 4.0, "lw": 1.2}
    look |= {"label": curve.label} | dict(curve.look)
    if not points:
        return
    if len(points[0]) == 2:
        axis.plot(*zip(*points, strict=True), **look)
        return
    at, middle, below, above = zip(*points, strict=True)
    axis.errorbar(at, middle, (below, above), capsize=3, **look)


def draw_study(rows: Rows, by: Sequence[str], path: AnyPath) -> None:
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
        if (point := _point(value, row[value])) is not None:
            at = in_unit(axis, row[axis]) if numeric else str(row[axis])
            lines.setdefault(name, []).append((at, *point))
    look = {} if numeric else {"ls": "none"}
    curves = [Curve(name, points, look) for name, points in lines.items()]
    shares = any(row[value] and "mean" not in row[value] for row in rows)
    y = f"{label_of(value)} [%]" if shares else label_of(value, unit=True)
    x = label_of(axis, unit=True)
    draw_curves({"": curves}, x, y, path, size=(5.4, 3.0))


def _point(name: str, found: Any) -> tuple[float, float, float] | None:
    """Return the middle and both ends of the interval of a value."""
    if found is None:
        return None
    if "mean" in found:
        mean, half = (in_unit(name, found[key]) for key in ("mean", "half"))
        return mean, half, half
    if "share" not in found:  # of a text: the share of its first value
        found = next(iter(found.values()))
    share, low, high = (100.0 * found[n] for n in ("share", "low", "high"))
    return share, share - low, high - share


def groups_of(rows: Rows, *keys: str) -> dict[Any, list[Mapping[str, Any]]]:
    """Return rows by the values of some keys, one value or a tuple."""
    found: dict[Any, list[Mapping[str, Any]]] = {}
    for row in rows:
        values = tuple(row[key] for key in keys)
        found.setdefault(values if keys[1:] else values[0], []).append(row)
    return found


def draw_survival(rows: Rows, units: Mapping[str, str], file: AnyPath) -> None:
    """Draw survival rates with 95 % intervals by kind and direction.

    Args:
        rows: Survival by method, kind, direction and strength.
        units: Unit of the strength of each kind of disturbance.
        file: Figure to write.
    """
    shown, labels = {}, []
    for (kind, direction), here in groups_of(
        rows, "kind", "direction"
    ).items():
        shown[f"{kind} {direction}".strip()] = [
            Curve(_trials(method, own), sorted(map(_rate, own)))
            for method, own in groups_of(here, "method").items()
        ]
        labels.append(f"{kind} [{units[kind]}]")
    draw_curves(shown, labels, "survived [%]", file)


def _rate(row: Mapping[str, Any]) -> tuple[float, float, float, float]:
    """Return strength, rate and the ends of its interval, in [%]."""
    share = 100.0 * row["survived"] / row["trials"]
    if row["trials"] == 1:  # an outcome has no interval
        return row["strength"], share, 0.0, 0.0
    low, high = 100.0 * row["low"], 100.0 * row["high"]
    return row["strength"], share, share - low, high - share


def _trials(method: str, rows: Rows) -> str:
    """Return a method with its number of trials per point, as text."""
    counts = sorted({row["trials"] for row in rows})
    number = " to ".join(
        f"{n}" for n in dict.fromkeys(counts[:: max(1, len(counts) - 1)])
    )
    return f"{method}, {number} trials per point"


def draw_limits(rows: Rows, file: AnyPath) -> None:
    """Draw the largest push survived over the gait phase, with bounds.

    Args:
        rows: Limits and bounds by method, direction and phase.
        file: Figure to write.
    """
    shown = {}
    for direction, here in groups_of(rows, "direction").items():
        curves = [
            Curve(
                method,
                sorted((row["phase"], row["limit_n_s"]) for row in own),
                {"ls": LINES[i % 4]},
            )
            for i, (method, own) in enumerate(
                groups_of(here, "method").items()
            )
        ]
        for key, label, width in (
            ("bound_n_s", "pendulum's bound", 1.6),
            ("impulse_bound_n_s", "bound for an impulse at mid-push", 0.6),
        ):
            points = sorted({(row["phase"], row[key]) for row in here})
            look = {"color": THEORY, "marker": "", "lw": width}
            curves.append(Curve(label, points, look))
        shown[f"push {direction}"] = curves
    x, y = "phase of the gait cycle [1]", "largest push survived [N s]"
    draw_curves(shown, x, y, file)


def draw_people(rows: Rows, clearance: float, file: AnyPath) -> None:
    """Draw the closest approach of people by direction and speed.

    Args:
        rows: Closest approach by sensing, speed and bearing.
        clearance: Clearance that the robot tries to keep, in [m].
        file: Figure to write.
    """
    shown = {}
    for sensing, here in groups_of(rows, "sensing").items():
        curves = []
        for speed, own in sorted(groups_of(here, "speed_m_s").items()):
            points = sorted((r["bearing_deg"], r["closest_m"]) for r in own)
            touched = sum(bool(r["contacts"]) for r in own)
            label = f"{speed:g} m/s, {touched} contacts"
            curves.append(Curve(label, points, {"ls": ":"}))
        ends = sorted(row["bearing_deg"] for row in here)
        level = [(ends[0], clearance), (ends[-1], clearance)]
        look = {"color": THEORY, "marker": "", "ls": "--"}
        curves.append(Curve(f"desired {clearance:g} m", level, look))
        shown[f"sensing: {sensing}"] = curves
    x = "direction of approach [deg], 0: from ahead, 90: from the left"
    draw_curves(shown, x, "closest approach [m]", file, size=(5.4, 3.0))


def draw_response(response: VelocityResponse, file: AnyPath) -> None:
    """Draw the delivered velocities of learned legs over commands.

    Args:
        response: Response of the legs.
        file: Figure to write.
    """
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


# Keys of the records and label of each panel.
DISTRIBUTIONS = (
    (("pursuer_radius_m", "evader_radius_m"), "radius of the path [m]"),
    (("distance_m",), "distance on the circle [m]"),
    (("relative_orientation_deg",), "angle between headings [deg]"),
    (("converged_at_s",), "time to reach the circle [s]"),
    (("min_distance_m",), "closest approach [m]"),
)


def draw_duels(
    groups: Mapping[str, Rows], summary: Mapping[str, Any], file: AnyPath
) -> None:
    """Draw histograms of the completed duels.

    Args:
        groups: Records of duels, with a row of panels for each name.
        summary: Summary of the duels, with the theory's values.
        file: Figure to write.
    """
    wide = len(DISTRIBUTIONS)
    rows = [LETTERS[wide * i : wide * (i + 1)] for i in range(len(groups))]
    figure, axes = panels(
        rows, 13.0, [1.3] * len(rows), legend=1, gaps=(0.2, 0.35)
    )
    for row, (name, records) in zip(rows, groups.items(), strict=True):
        played = [r for r in records if r["outcome"] == "completed"]
        for letter, first, (keys, label) in zip(
            row, rows[0], DISTRIBUTIONS, strict=True
        ):
            axis = axes[letter]
            if axis is not axes[first]:
                axis.sharex(axes[first])
            values = {
                key: [r[key] for r in played if r[key] is not None]
                for key in keys
            }
            _draw_histogram(axis, values, summary["figures"])
            axis.set_yticks([])
            axis.set_xlabel(label if row == rows[-1] else "")
        text = f"{name}\n{len(played)} duels".strip()
        axes[row[0]].set_ylabel(text)
    legend_below(figure, axes.values(), ncols=4)
    save(figure, file)


def _draw_histogram(
    axis: Any,
    values: Mapping[str, Sequence[float]],
    figures: Mapping[str, Any],
) -> None:
    """Draw the distributions of some values, with theory or mean."""
    every = np.concatenate([*values.values()])
    if not len(every):
        return
    bins = np.linspace(every.min() - 1e-3, every.max() + 1e-3, 41)
    for (key, own), hatch in zip(values.items(), ("", "///"), strict=False):
        role = key.split("_")[0] if len(values) > 1 else ""
        colour = COLOURS.get(role, LEFT)
        look = {"color": colour, "alpha": 0.6, "hatch": hatch}
        axis.hist(own, bins, label=role or None, **look)
    for theory in {figures.get(key, {}).get("theory") for key in values}:
        if theory is not None:
            axis.axvline(theory, color=THEORY, ls="--", lw=1.2, label="theory")
    if len(values) == 1:
        axis.axvline(every.mean(), color=RIGHT, lw=1.2, label="mean")
