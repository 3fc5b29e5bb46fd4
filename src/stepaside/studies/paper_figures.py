"""What the paper's own figures show, as far as their words tell."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

TICK = 0.5  # between the ticks of the axes of Fig. 2, in [m]
NOT_MEASURED = "not measured"
_NOWHERE = "neither caption nor text"


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


class _Shown(NamedTuple):
    """A row before it is filled in.

    ``ours`` holds a place for what each of the ``claims`` measured, and for
    ``turns``, ``end``, ``ticks`` and ``across``; see :func:`paper_figures`.
    """

    figure: str
    what: str
    paper: str
    source: str
    ours: str
    claims: tuple[str, ...] = ()


_SHOWN = (
    _Shown(
        "2", "scale", "ticks 0.5 m apart", "caption of Fig. 2",
        "ticks 0.5 m apart",
    ),
    _Shown(
        "2", "values", "v = 1 m/s, k = 0.5; start not given", "II-C",
        "the same; start 5 m apart, the pursuer 0.4 rad off, the evader "
        "0.2 rad",
    ),
    _Shown(
        "2", "snapshots",
        "four: start; approach and begin of the evasion; approaching and "
        "settled on a circle",
        "II-C",
        "four, the last after {end:.1f} s",
    ),
    _Shown(
        "2", "radius of the circle", "not given", _NOWHERE,
        "{0:.3f} m: {ticks:.2f} ticks, the circle is {across:.1f} ticks "
        "across",
        ("circle.pursuer_radius",),
    ),
    _Shown(
        "2", "number of turns", "not given", _NOWHERE,
        "{turns:.2f} of the pursuer until the last snapshot",
    ),
    _Shown(
        "2", "relative orientation", "pi/2", "II-C",
        "{0:.4f} rad",
        ("circle.orientation",),
    ),
    _Shown(
        "2", "speeds", "the same", "II-C",
        "ratio {0:.4f}",
        ("circle.same_speed",),
    ),
    _Shown(
        "5", "paths",
        "CoMs in red (pursuer) and blue (evader); side and top views; no "
        "scale, no times",
        "caption of Fig. 5, IV",
        "CoMs in the same colours, top views with axes and times",
    ),
    _Shown(
        "5", "circle", "one circular limit cycle; radius not given", "IV",
        "radii {0:.3f} m and {1:.3f} m, centres {2:.1g} m apart",
        (
            "humanoids.pursuer_radius",
            "humanoids.evader_radius",
            "humanoids.one_circle",
        ),
    ),
    _Shown(
        "5", "relative orientation", "pi/2", "IV",
        "{0:.1f} deg",
        ("humanoids.orientation",),
    ),
    _Shown(
        "5", "speeds", "the same", "IV",
        "ratio {0:.3f}",
        ("humanoids.same_speed",),
    ),
    _Shown(
        "6", "circle",
        "the limit cycle again, its radius slightly reduced with respect to "
        "the simulation; no number",
        "IV",
        "radius {0:.2f} times that on a floor with grip",
        ("slip.smaller",),
    ),
    _Shown(
        "6", "speed",
        "less than 0.1 m/s, as feet slip on the smooth floor", "IV",
        "{0:.2f} times that on a floor with grip, where it is {1:.3f} m/s; "
        "feet slip {2:.1f} times as far",
        ("slip.slower", "durations.speed", "slip.slide"),
    ),
)  # fmt: skip


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
    measured = {row["name"]: row.get("measured") for row in rows}
    filled = []
    for shown in _SHOWN:
        values: list[Any] = [measured.get(name) for name in shown.claims]
        text = NOT_MEASURED
        if None not in values:
            ticks = values[0] / TICK if values else 0.0
            text = shown.ours.format(
                *values, turns=turns, end=end, ticks=ticks, across=2.0 * ticks
            )
        filled.append(FigureRow(*shown[:4], text))
    return filled
