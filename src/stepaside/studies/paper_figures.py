"""What the paper's own figures show, as far as their words tell."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

TICK = 0.5  # between the ticks of the axes of Fig. 2, in [m]


class FigureRow(NamedTuple):
    """One thing that a figure of the paper shows.

    Attributes:
        figure: Number of the figure.
        what: What it shows.
        paper: What caption or text say of it.
        source: Where they do.
        ours: What we measured of the same.
    """

    figure: str
    what: str
    paper: str
    source: str
    ours: str


def paper_figures(
    rows: Sequence[Mapping[str, Any]], turns: float, end: float
) -> list[FigureRow]:
    """Figures of the paper beside ours.

    Args:
        rows: Rows of the claims, as JSON objects; what is not among them is
            left out.
        turns: Turns of the pursuer in our figure in the manner of Fig. 2.
        end: Time of its last snapshot, in [s].
    """
    by_name = {row["name"]: row for row in rows}

    def ours(text: str, *names: str) -> str:
        """Fill measured values in; nothing if one of them is missing."""
        values = [by_name.get(name, {}).get("measured") for name in names]
        if any(value is None for value in values):
            return "not measured"
        return text.format(*values)

    radius = by_name.get("circle.pursuer_radius", {}).get("measured")
    ticks = "not measured"
    if radius is not None:
        ticks = (
            f"{radius:.3f} m: {radius / TICK:.2f} ticks, the circle is "
            f"{2.0 * radius / TICK:.1f} ticks across"
        )
    nowhere = "neither caption nor text"
    fig2 = "caption of Fig. 2"
    return [
        FigureRow(
            "2", "scale", "ticks 0.5 m apart", fig2, "ticks 0.5 m apart"
        ),
        FigureRow(
            "2",
            "values",
            "v = 1 m/s, k = 0.5; start not given",
            "II-C",
            "the same; start 5 m apart, the pursuer 0.4 rad off, the evader "
            "0.2 rad",
        ),
        FigureRow(
            "2",
            "snapshots",
            "four: start; approach and begin of the evasion; approaching "
            "and settled on a circle",
            "II-C",
            f"four, the last after {end:.1f} s",
        ),
        FigureRow("2", "radius of the circle", "not given", nowhere, ticks),
        FigureRow(
            "2",
            "number of turns",
            "not given",
            nowhere,
            f"{turns:.2f} of the pursuer until the last snapshot",
        ),
        FigureRow(
            "2",
            "relative orientation",
            "pi/2",
            "II-C",
            ours("{:.4f} rad", "circle.orientation"),
        ),
        FigureRow(
            "2",
            "speeds",
            "the same",
            "II-C",
            ours("ratio {:.4f}", "circle.same_speed"),
        ),
        FigureRow(
            "5",
            "paths",
            "CoMs in red (pursuer) and blue (evader); side and top views; no "
            "scale, no times",
            "caption of Fig. 5, IV",
            "CoMs in the same colours, top views with axes and times",
        ),
        FigureRow(
            "5",
            "circle",
            "one circular limit cycle; radius not given",
            "IV",
            ours(
                "radii {:.3f} m and {:.3f} m, centres {:.1g} m apart",
                "humanoids.pursuer_radius",
                "humanoids.evader_radius",
                "humanoids.one_circle",
            ),
        ),
        FigureRow(
            "5",
            "relative orientation",
            "pi/2",
            "IV",
            ours("{:.1f} deg", "humanoids.orientation"),
        ),
        FigureRow(
            "5",
            "speeds",
            "the same",
            "IV",
            ours("ratio {:.3f}", "humanoids.same_speed"),
        ),
        FigureRow(
            "6",
            "circle",
            "the limit cycle again, its radius slightly reduced with respect "
            "to the simulation; no number",
            "IV",
            ours(
                "radius {:.2f} times that on a floor with grip",
                "slip.smaller",
            ),
        ),
        FigureRow(
            "6",
            "speed",
            "less than 0.1 m/s, as feet slip on the smooth floor",
            "IV",
            ours(
                "{:.2f} times that on a floor with grip, where it is {:.3f} "
                "m/s; feet slip {:.1f} times as far",
                "slip.slower",
                "durations.speed",
                "slip.slide",
            ),
        ),
    ]
