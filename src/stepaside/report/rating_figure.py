"""Figure of a rating: closest approach by world and opponent."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .figure_style import plt, save

COLOURS = (
    *("blue", "orange", "green", "red", "purple"),
    *("brown", "pink", "gray", "olive", "cyan"),
)


def draw_rating(rows: Sequence[Mapping[str, Any]], path: str) -> None:
    """Draw the closest approach of each strategy, one panel for each world.

    Args:
        rows: Rows of :func:`stepaside.studies.strategy_rating.rating_rows`.
        path: File to write; its suffix gives the format.
    """
    worlds = list(dict.fromkeys(row["world"] for row in rows))
    opponents = list(dict.fromkeys(row["opponent"] for row in rows))
    names = list(dict.fromkeys(row["strategy"] for row in rows))
    figure, panels = plt.subplots(
        1,
        len(worlds),
        figsize=(2.4 * len(worlds) + 0.6, 3.4),
        sharey=True,
        squeeze=False,
    )
    wide = 0.8 / len(names)
    for world, axes in zip(worlds, panels[0], strict=True):
        for n, name in enumerate(names):
            own = [
                row
                for row in rows
                if (row["strategy"], row["world"]) == (name, world)
            ]
            places = np.array([opponents.index(r["opponent"]) for r in own])
            axes.bar(
                places + (n - 0.5 * (len(names) - 1)) * wide,
                [row["mean_closest_m"] for row in own],
                wide,
                yerr=[row["mean_closest_pm_m"] for row in own],
                color=f"tab:{COLOURS[n % len(COLOURS)]}",
                label=name.rpartition("/")[2],
            )
        axes.set_title(world, fontsize=9)
        axes.set_xticks(range(len(opponents)), opponents, rotation=45)
    panels[0][0].set_ylabel("closest approach [m], mean and 95 %")
    panels[0][-1].legend(fontsize=7)
    save(figure, path)
