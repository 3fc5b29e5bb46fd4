"""Figures of the paper, as described by captions and text, with ours."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

TICK = 0.5  # distance of the ticks of the axes of Fig. 2, in [m]
NOT_MEASURED = "not measured"
_NOWHERE = "neither caption nor text"


class FigureRow(NamedTuple):
    """One property of a figure of the paper, with our value.

    Attributes:
        figure: Number of the figure.
        what: Name of the property.
        paper: Value by caption or text.
        source: Caption or section that gives it.
        ours: Our value.
    """

    figure: str
    what: str
    paper: str
    source: str
    ours: str


class _RowTemplate(NamedTuple):
    """Template of a row.

    ``ours`` is a format string with the measured values of ``claims``, and
    with ``turns``, ``end``, ``ticks`` and ``across``; see
    :func:`paper_figures`.
    """

    figure: str
    what: str
    paper: str
    source: str
    ours: str
    claims: tuple[str, ...] = ()


_TEMPLATES = (
    _RowTemplate(
        "2", "scale", "ticks 0.5 m apart", "caption of Fig. 2",
        "ticks 0.5 m apart",
    ),
    _RowTemplate(
        "2", "values", "v = 1 m/s, k = 0.5; start not given", "II-C",
        "the same; start 5 m apart, the pursuer 0.4 rad off, the evader "
        "0.2 rad",
    ),
    _RowTemplate(
        "2", "snapshots",
        "four: start; approach and begin of the evasion; approaching and "
        "settled on a circle",
        "II-C",
        "four, the last after {end:.1f} s",
    ),
    _RowTemplate(
        "2", "radius of the circle", "not given", _NOWHERE,
        "{0:.3f} m: {ticks:.2f} ticks, the circle is {across:.1f} ticks "
        "across",
        ("circle.pursuer_radius",),
    ),
    _RowTemplate(
        "2", "number of turns", "not given", _NOWHERE,
        "{turns:.2f} of the pursuer until the last snapshot",
    ),
    _RowTemplate(
        "2", "relative orientation", "pi/2", "II-C",
        "{0:.4f} rad",
        ("circle.orientation",),
    ),
    _RowTemplate(
        "2", "speeds", "the same", "II-C",
        "ratio {0:.4f}",
        ("circle.same_speed",),
    ),
    _RowTemplate(
        "5", "paths",
        "CoMs in red (pursuer) and blue (evader); side and top views; no "
        "scale, no times",
        "caption of Fig. 5, IV",
        "CoMs in the same colours, top views with axes and times",
    ),
    _RowTemplate(
        "5", "circle", "one circular limit cycle; radius not given", "IV",
        "radii {0:.3f} m and {1:.3f} m, centres {2:.1g} m apart",
        (
            "humanoids.pursuer_radius",
            "humanoids.evader_radius",
            "humanoids.one_circle",
        ),
    ),
    _RowTemplate(
        "5", "relative orientation", "pi/2", "IV",
        "{0:.1f} deg",
        ("humanoids.orientation",),
    ),
    _RowTemplate(
        "5", "speeds", "the same", "IV",
        "ratio {0:.3f}",
        ("humanoids.same_speed",),
    ),
    _RowTemplate(
        "6", "circle",
        "the limit cycle again, its radius slightly reduced with respect to "
        "the simulation; no number",
        "IV",
        "radius {0:.2f} times that on a floor with grip",
        ("slip.smaller",),
    ),
    _RowTemplate(
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
    """Compare the figures of the paper with ours.

    Args:
        rows: Rows of the claims, as JSON objects; missing claims appear as
            "not measured".
        turns: Turns of the pursuer in our version of Fig. 2.
        end: Time of its last snapshot, in [s].
    """
    measured = {row["name"]: row.get("measured") for row in rows}
    filled = []
    for template in _TEMPLATES:
        values: list[Any] = [measured.get(name) for name in template.claims]
        text = NOT_MEASURED
        if None not in values:
            ticks = values[0] / TICK if values else 0.0
            text = template.ours.format(
                *values, turns=turns, end=end, ticks=ticks, across=2.0 * ticks
            )
        filled.append(FigureRow(*template[:4], text))
    return filled
