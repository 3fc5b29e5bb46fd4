"""Histograms of the measurements of many duels."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .figure_style import (
    COLOURS,
    LEFT,
    RIGHT,
    THEORY,
    add_common_legend,
    new_figure,
    save,
)

# Keys of the records and label of each panel.
PANELS = (
    (("pursuer_radius_m", "evader_radius_m"), "radius of the path [m]"),
    (("distance_m",), "distance on the circle [m]"),
    (("relative_orientation_deg",), "angle between headings [deg]"),
    (("converged_at_s",), "time to reach the circle [s]"),
    (("min_distance_m",), "closest approach [m]"),
)
BINS = 40
DISTRIBUTION = {
    "pursuer_radius_m": COLOURS["pursuer"],
    "evader_radius_m": COLOURS["evader"],
}


def draw_duels(
    groups: Mapping[str, Sequence[Mapping[str, Any]]],
    summary: Mapping[str, Any],
    file: Path,
) -> None:
    """Draw histograms of the completed duels.

    Args:
        groups: Records of duels, with a row of panels for each name.
        summary: Summary of the duels, with the theory's values.
        file: Figure to write.
    """
    figure = new_figure(2.6 * len(PANELS), 0.6 + 2.0 * len(groups))
    axes = figure.subplots(
        len(groups), len(PANELS), squeeze=False, sharex="col"
    )
    *_, last = groups
    for row, (name, records) in zip(axes, groups.items(), strict=True):
        played = [r for r in records if r["outcome"] == "completed"]
        for axis, (keys, label) in zip(row, PANELS, strict=True):
            _draw_panel(axis, keys, played, summary)
            axis.set_yticks([])
            if name == last:
                axis.set_xlabel(label)
        row[0].set_ylabel(f"{name}\n{len(played)} duels".strip())
    add_common_legend(figure, axes[0], ncols=4)
    save(figure, file)


def _draw_panel(
    axis: Any,
    keys: Sequence[str],
    records: Sequence[Mapping[str, Any]],
    summary: Mapping[str, Any],
) -> None:
    every = [r[key] for key in keys for r in records if r[key] is not None]
    if not every:
        return
    low, high = min(every), max(every)
    room = 0.02 * max(high - low, 1e-3)
    bins = np.linspace(low - room, high + room, BINS)
    for key, hatch in zip(keys, ("", "///"), strict=False):
        colour = DISTRIBUTION.get(key, LEFT)
        axis.hist(
            [r[key] for r in records if r[key] is not None],
            bins,
            color=colour,
            alpha=0.6,
            hatch=hatch,
            label=key.split("_")[0] if len(keys) > 1 else None,
        )
    figures = [summary["figures"].get(key, {}) for key in keys]
    for theory in {f.get("theory") for f in figures} - {None}:
        axis.axvline(
            theory,
            color=THEORY,
            linestyle="--",
            linewidth=1.2,
            label="theory",
        )
    if len(keys) == 1:
        axis.axvline(
            float(np.mean(every)), color=RIGHT, linewidth=1.2, label="mean"
        )
