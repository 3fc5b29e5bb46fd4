"""Labels and units of result entries, by their names."""

from math import degrees

# Units by suffix of a name; the longest match counts. Angles are shown in
# degrees.
UNITS = {
    "_per_s": "1/s",
    "_rad_s": "rad/s",
    "_n_s": "N s",
    "_m_s": "m/s",
    "_rad": "deg",
    "_deg_s": "deg/s",
    "_deg": "deg",
    "_us": "us",
    "_hz": "Hz",
    "share": "%",
    "_m2": "m^2",
    "_kg": "kg",
    "_m": "m",
    "_s": "s",
}
# Labels of names that are not clear by themselves.
LABELS = {
    "bearing_rad": "bearing of the pursuer",
    "capture_m": "capture distance",
    "captured_share": "games captured",
    "closed": "closed walls",
    "closest_distance_m": "closest approach",
    "com_heights_m": "CoM heights in reach, least and greatest",
    "coupled": "coupled joints",
    "end_time_s": "final time",
    "evader_error_rad": "heading error of the evader",
    "exists": "circle exists",
    "falling_m": "decrease of a value in the last period, at most",
    "headings_apart_rad": "angle between headings",
    "lengths_share": "feasible share of stride and step height",
    "mean_closest_distance_m": "mean closest approach",
    "min_distance_m": "closest approach",
    "min_zmp_margin_m": "minimum ZMP margin",
    "missing_values": "marked ASK",
    "motions_apart_rad": "angle between motions",
    "pursuer_error_rad": "heading error of the pursuer",
    "radius_evader_m": "evader's radius",
    "radius_pursuer_m": "pursuer's radius",
    "relative_orientation_deg": "angle between headings",
    "settled_share": "games settled",
    "share": "share of games",
    "settled_time_largest_s": "maximum settling time",
    "settled_time_median_s": "median settling time",
    "seconds_s": "solver time",
    "sliding": "evader slides at zero error",
    "unsettled_share": "games not settled",
    "barrier_error_m": "mean error of the barrier",
    "goal_at_s": "goal reached at",
    "grid_error_m": "mean difference to a grid of half the cells",
    "intimate_s": "time within 0.45 m",
    "intimate_share": "share of time within 0.45 m",
    "personal_share": "share of time within 1.2 m",
    "lost_s": "time without a sighting",
    "misled_s": "time with a wrong bearing",
    "personal_s": "time within 1.2 m",
}
CIRCLES = {1: "main", -1: "reversed"}
"""Names of the circles of a game of unicycles, by their direction."""


def unit_of(name: str) -> str:
    """Return the unit of a name by its suffix; empty if it has none."""
    return UNITS.get(_unit_suffix(name), "")


def _unit_suffix(name: str) -> str:
    suffixes = (suffix for suffix in UNITS if name.endswith(suffix))
    return max(suffixes, key=len, default="")


def label_of(name: str, *, unit: bool = False) -> str:
    """Return the label of an entry, with its unit in brackets if asked for."""
    whose, _, last = name.rpartition(".")
    label = LABELS.get(name) or name.removesuffix(_unit_suffix(name))
    if last in LABELS and whose:
        label = f"{whose}: {LABELS[last]}"
    label = label.replace("_", " ").strip()
    symbol = unit_of(name)
    return f"{label} [{symbol}]" if unit and symbol else label


def in_unit(name: str, value: float) -> float:
    """Return a value in the unit of its name: angles in [deg], shares in %."""
    if name.endswith("_rad"):
        return degrees(value)
    return 100.0 * value if unit_of(name) == "%" else value
