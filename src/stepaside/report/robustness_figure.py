"""Figures of a robustness campaign: survival rates and largest pushes."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.patches import Patch

from .figure_sizes import sheet
from .figure_style import THEORY, add_common_legend, panel_grid, save

METHOD_STYLES = {
    "open-loop": ("#8a8a8a", "o", ":"),
    "closed-form": ("#b5651d", "s", "--"),
    "measured": ("#0f7b6c", "D", "-"),
    "mpc": ("#6a3d9a", "^", "-."),
}
SIDES = ("left", "right")
BOUNDS = (  # column, label, width of the line
    ("bound_n_s", "pendulum's bound", 1.6),
    ("impulse_bound_n_s", "bound for an impulse at mid-push", 0.6),
)


def draw_survival(
    rows: Sequence[Mapping[str, Any]], units: dict[str, str], file: Path
) -> None:
    """Draw survival rates with 95 % intervals by kind and direction.

    Args:
        rows: Survival by method, kind, direction and strength.
        units: Unit of the strength of each kind of disturbance.
        file: Figure to write.
    """
    panels = list(dict.fromkeys((r["kind"], r["direction"]) for r in rows))
    figure, axes = panel_grid(len(panels), 3.1, 2.6)
    for axis, (kind, direction) in zip(axes.flat, panels, strict=False):
        here = [
            r for r in rows if (r["kind"], r["direction"]) == (kind, direction)
        ]
        _draw_rates(axis, here)
        axis.set_title(_title(kind, direction))
        axis.set_xlabel(f"{kind} [{units[kind]}]")
        axis.set_ylim(-4, 104)
    single = all(r["trials"] == 1 for r in rows)
    for row in axes:
        row[0].set_ylabel("" if single else "survived [%]")
        if single:
            row[0].set_yticks([0.0, 100.0], ["fell", "survived"])
    interval = Patch(color=THEORY, alpha=0.12, linewidth=0)
    add_common_legend(
        figure,
        axes.flat,
        {} if single else {"95 % interval": interval},
        ncols=2 if sheet().narrow else 4,
    )
    save(figure, file)


def _draw_rates(axis: Any, rows: Sequence[Mapping[str, Any]]) -> None:
    """Draw the survival rate of each method over the strength."""
    for method in dict.fromkeys(r["method"] for r in rows):
        colour, marker, line = METHOD_STYLES[method]
        own = sorted(
            (r for r in rows if r["method"] == method),
            key=lambda r: float(r["strength"]),
        )
        x = [r["strength"] for r in own]
        share = np.array([r["survived"] / r["trials"] for r in own])
        trials = sorted({r["trials"] for r in own})
        single = trials == [1]
        axis.plot(
            x,
            100.0 * share,
            color=colour,
            marker=marker,
            # A single trial has an outcome but no rate.
            linestyle="none" if single else line,
            markersize=4,
            label=f"{method}, {_count(trials)}",
        )
        if single:
            continue
        axis.fill_between(
            x,
            [100.0 * r["low"] for r in own],
            [100.0 * r["high"] for r in own],
            color=colour,
            alpha=0.12,
            linewidth=0,
        )


def _title(kind: str, direction: str) -> str:
    """Return kind and direction of a disturbance as text."""
    if direction in SIDES:
        return f"{kind} to the {direction}"
    return f"{kind} {direction}".strip()


def _count(trials: Sequence[int]) -> str:
    """Return the number of trials per point as text."""
    low, high = trials[0], trials[-1]
    if low == high:
        return f"{low} trial{'s' if low > 1 else ''} per point"
    return f"{low} to {high} trials per point"


def draw_limits(rows: Sequence[Mapping[str, Any]], file: Path) -> None:
    """Draw the largest push survived over the gait phase, with bounds.

    Args:
        rows: Limits and bounds by method, direction and phase.
        file: Figure to write.
    """
    directions = list(dict.fromkeys(r["direction"] for r in rows))
    figure, axes = panel_grid(len(directions), 3.1, 3.0, columns=8)
    for axis, direction in zip(axes.flat, directions, strict=False):
        here = [r for r in rows if r["direction"] == direction]
        for method in dict.fromkeys(r["method"] for r in here):
            colour, marker, line = METHOD_STYLES[method]
            own = sorted(
                (r for r in here if r["method"] == method),
                key=lambda r: float(r["phase"]),
            )
            x = [r["phase"] for r in own]
            axis.plot(
                x,
                [r["limit_n_s"] for r in own],
                color=colour,
                marker=marker,
                linestyle=line,
                markersize=4,
                label=method,
            )
        for name, label, width in BOUNDS:
            bounds = sorted({(r["phase"], r[name]) for r in here})
            axis.plot(
                *zip(*bounds, strict=True),
                color=THEORY,
                linewidth=width,
                label=label,
            )
        axis.set_title(_title("push", direction))
        axis.set_xlabel("phase of the gait cycle [1]")
    # Last, because a fixed limit ends autoscaling of the shared axes.
    axes.flat[0].set_ylim(bottom=0.0)
    for row in axes:
        row[0].set_ylabel("largest push survived [N s]")
    add_common_legend(figure, axes.flat[:1], ncols=2 if sheet().narrow else 6)
    save(figure, file)
