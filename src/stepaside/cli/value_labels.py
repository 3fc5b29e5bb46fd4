"""Names and values of results as people read them."""

from collections.abc import Iterable, Mapping
from math import degrees
from typing import Any

# Ends of names and what they mean; the longest that fits counts. Angles are
# shown in degrees.
UNITS = {
    "_per_s": "1/s",
    "_rad_s": "rad/s",
    "_m_s": "m/s",
    "_rad": "deg",
    "_deg": "deg",
    "_share": "%",
    "_m2": "m^2",
    "_kg": "kg",
    "_m": "m",
    "_s": "s",
}
# Where the words of a name alone would not say enough.
NAMES = {
    "angle_rad": "strategy angle",
    "body_m": "capture distance",
    "bearing_rad": "bearing of the pursuer",
    "body_radius_m": "radius of a body",
    "capture_m": "capture distance",
    "captured_share": "games captured",
    "closed": "walls closed",
    "closest_distance_m": "closest approach",
    "coupled": "coupled joints",
    "end_time_s": "time at the end",
    "eigenvalues_per_s": "eigenvalues",
    "evader_error_rad": "error of the evader",
    "exists": "circle exists",
    "falling_mean_m": "fall of the value in the last tenth, mean",
    "falling_worst_m": "fall of the value in the last tenth, most",
    "floor_m2": "floor",
    "floor_used_evader_m": "farthest of the evader from its start",
    "free_for_body_m2": "floor for the centre of a body",
    "free_m2": "floor without obstacles",
    "headings_apart_rad": "angle between headings",
    "mean_closest_distance_m": "mean closest approach",
    "min_distance_m": "closest approach",
    "min_zmp_margin_m": "least ZMP margin",
    "motions_apart_rad": "angle between motions",
    "pursuer_error_rad": "error of the pursuer",
    "radius_evader_m": "evader's radius",
    "radius_pursuer_m": "pursuer's radius",
    "relative_orientation_deg": "angle between headings",
    "settled_share": "games settled",
    "settled_time_largest_s": "longest time to settle",
    "settled_time_median_s": "median time to settle",
    "seconds_s": "time to solve",
    "sliding": "evader slides on zero error",
    "unsettled_share": "games not settled",
}


def unit_of(name: str) -> str:
    """Unit that the end of a name tells; empty if it tells none."""
    ends = [end for end in UNITS if name.endswith(end)]
    return UNITS[max(ends, key=len)] if ends else ""


def label_of(name: str, *, unit: bool = False) -> str:
    """Words for a name of a result.

    Args:
        name: Like ``closest_distance_m``.
        unit: Whether its unit stands behind them, in brackets.
    """
    shown = unit_of(name)
    words = NAMES.get(name)
    if words is None:
        ends = [end for end in UNITS if name.endswith(end)]
        words = name.removesuffix(max(ends, key=len, default=""))
    words = words.replace("_", " ")
    return f"{words} [{shown}]" if unit and shown else words


def text_of(name: str, value: Any, digits: int = 6) -> str:
    """A value with the unit that its name tells.

    Args:
        name: Of the value.
        value: In the unit of the name; pairs are real and imaginary parts.
        digits: That are shown.
    """
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    unit = unit_of(name)
    if isinstance(value, list):
        pairs = [f"{re:.{digits}g}{im:+.{digits}g}i" for re, im in value]
        text = ", ".join(pairs)
    elif isinstance(value, Mapping):
        text = ", ".join(f"{one} by {other}" for one, other in value.items())
        return text or "none"
    elif isinstance(value, int | float):
        if name.endswith("_rad"):
            value = degrees(value)
        elif unit == "%":
            value = 100.0 * value
        text = f"{value:.{digits}g}"
    else:
        return str(value)
    return f"{text} {unit}".strip()


def rows_of(
    result: Mapping[str, Any], names: Iterable[str], digits: int = 6
) -> list[tuple[str, str]]:
    """Rows of a table, with labels and units, of some entries of a result."""
    return [
        (label_of(name), text_of(name, result[name], digits)) for name in names
    ]
