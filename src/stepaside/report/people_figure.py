"""Polar plot of the closest approach of people by direction and speed."""

from collections.abc import Mapping, Sequence
from math import radians
from pathlib import Path
from typing import Any

from .figure_style import THEORY, add_common_legend, new_figure, plt, save


def draw_people(
    rows: Sequence[Mapping[str, Any]], clearance: float, file: Path
) -> None:
    """Draw the closest approach by direction, with a colour for each speed.

    Ahead of the robot is up. A cross marks a contact.

    Args:
        rows: Closest approach by sensing, speed and bearing.
        clearance: Clearance that the robot tries to keep, in [m].
        file: Figure to write.
    """
    ways = list(dict.fromkeys(row["sensing"] for row in rows))
    speeds = sorted({row["speed_m_s"] for row in rows})
    figure = new_figure(5.4 * len(ways), 5.2)
    axes = figure.subplots(
        1, len(ways), squeeze=False, subplot_kw={"projection": "polar"}
    )
    for axis, sensing in zip(axes.flat, ways, strict=True):
        axis.set_theta_zero_location("N")
        ring = [radians(3.0 * i) for i in range(121)]
        axis.plot(
            ring,
            [clearance] * 121,
            color=THEORY,
            linewidth=1.0,
            label=f"desired clearance {clearance:g} m",
        )
        for i, speed in enumerate(speeds):
            here = sorted(
                (
                    row
                    for row in rows
                    if (row["sensing"], row["speed_m_s"]) == (sensing, speed)
                ),
                key=lambda row: float(row["bearing_deg"]),
            )
            colour = plt.cm.viridis(i / max(1, len(speeds) - 1))
            axis.plot(
                [radians(row["bearing_deg"]) for row in here],
                [row["closest_m"] for row in here],
                color=colour,
                marker="o",
                markersize=4,
                linestyle="none",
                label=f"{speed:g} m/s",
            )
            touched = [row for row in here if row["contacts"]]
            axis.plot(
                [radians(row["bearing_deg"]) for row in touched],
                [row["closest_m"] for row in touched],
                color=colour,
                marker="x",
                markersize=11,
                linestyle="none",
                label="contact" if touched else None,
            )
        axis.set_ylim(0.0)
        axis.set_title(
            "closest approach [m] over the direction of approach\n"
            f"(0°: from ahead, 90°: from the left); sensing: {sensing}"
        )
    add_common_legend(figure, axes.flat, title="speed of the person", ncols=3)
    save(figure, file)
