"""Survival in rooms by opponent, closest approach, floor area used."""

from collections.abc import Mapping
from typing import Any

from .markdown import NONE, interval, number, table

Result = Mapping[str, Any]


def worlds(result: Result) -> str:
    """List every evader in every room against one pursuer."""
    head = (
        "world",
        "evader",
        "pursuer",
        "games",
        "survived",
        "95 %",
        "touched",
        "captured",
        "closest [m]",
        "of the bound",
        "floor used [m²]",
        "turning [rad/s]",
        "decision [ms]",
    )
    rows = []
    for world, found in result["worlds"].items():
        for row in found:
            low, high = row["survived_low"], row["survived_high"]
            rows.append(
                (
                    world,
                    row["evader"],
                    row["pursuer"],
                    str(row["games"]),
                    f"{100 * row['survived']:.1f} %",
                    f"{100 * low:.1f}-{100 * high:.1f}",
                    f"{100 * row['touched_obstacle']:.1f} %",
                    f"{100 * row['captured']:.1f} %",
                    number(row["mean_closest_m"], 3),
                    number(row["closest_over_bound"], 3),
                    number(row["floor_used_m2"], 2),
                    number(row["turning_rad_s"], 3),
                    number(row["decision_ms"], 2),
                )
            )
    return table(head, rows)


def opponents(result: Result) -> str:
    """List survival against each pursuer, with the paper's circle."""
    met = result["opponents"]
    head = (
        "pursuer",
        "circle [m]",
        "capture [m]",
        *(
            f"{each['evader']}, {each['world']} (n = {row['games']})"
            for each in met
            for row in each["rows"][:1]
        ),
    )
    rows = [
        (
            row["pursuer"],
            number(row["circle_distance_m"], 3),
            number(row["capture_distance_m"], 3),
            *(_survived(each["rows"][i]) for each in met),
        )
        for i, row in enumerate(met[0]["rows"])
    ]
    return table(head, rows)


def _survived(row: Mapping[str, Any]) -> str:
    """Return the survival rate with its 95 % interval."""
    ends = 100 * row["survived_low"], 100 * row["survived_high"]
    return f"{100 * row['survived']:.0f} % ({interval(*ends, 0)})"


def sizes(result: Result) -> str:
    """List survival in square rooms without obstacles, by size."""
    names = [
        f"{row['evader']} against {row['pursuer']} (n = {row['games']})"
        for row in result["sizes"][0]["rows"]
    ]
    rows = [
        (
            f"{entry['size_m']:g} x {entry['size_m']:g} m",
            *(_survived(row) for row in entry["rows"]),
        )
        for entry in result["sizes"]
    ]
    return table(("room", *names), rows)


def ladder(result: Result) -> str:
    """List survival against each pursuer, beside an offline search."""
    head = (
        "world",
        "pursuer",
        "evader",
        "games",
        "survived",
        "mean survival [s]",
        "offline search [s]",
        "of it",
        "decision [ms]",
        "longest [ms]",
    )
    rows = []
    for world, found in result["worlds"].items():
        for row in found["rows"]:
            times = found["offline_s"].get(row["pursuer"])
            best = sum(times) / len(times) if times else None
            same = row["survival_in_searched_rooms_s"]
            low, high = row["survived_low"], row["survived_high"]
            share = f"{100 * row['survived']:.0f} %"
            rows.append(
                (
                    world,
                    row["pursuer"],
                    row["evader"],
                    str(row["games"]),
                    f"{share} ({100 * low:.0f}-{100 * high:.0f})",
                    number(row["mean_survival_s"], 1),
                    NONE if best is None else number(best, 1),
                    NONE
                    if best is None
                    else number(sum(same) / len(same) / best, 2),
                    number(row["decision_ms"], 1),
                    number(row["longest_decision_ms"], 0),
                )
            )
    return table(head, rows)


def open_floor(*results: Result) -> str:
    """List survival on an open floor by the value of two cars."""
    head = (
        *("pursuer", "evader", "starts that must be survived", "survived"),
        *("other starts", "survived of these"),
    )
    rows = [
        (
            row["pursuer"],
            row["evader"],
            str(row["sure"]),
            _of(row["sure_survived"], row["sure"]),
            str(row["open"]),
            _of(row["open_survived"], row["open"]),
        )
        for result in results
        for row in result["rows"]
    ]
    return table(head, rows)


def _of(number_of: int, total: int) -> str:
    """Return a number of starts, or a dash where there are none."""
    return str(number_of) if total else NONE
