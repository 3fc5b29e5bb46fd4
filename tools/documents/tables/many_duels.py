"""Studies of many duels: outcomes, values with intervals, certificates."""

from collections.abc import Mapping
from typing import Any

from .duels import words_of
from .markdown import interval, number, table

Result = Mapping[str, Any]
KINDS = {
    "duels-ideal": "ideal",
    "duels-hardware": "hardware-like",
    "duels-cameras": "ideal, with cameras",
}


def outcomes(results: Mapping[str, Result]) -> str:
    """List rates of outcomes of each kind of duel, with 95 % intervals."""
    head = (
        *("body", "seeds", "duels", "played to the end"),
        *("on the circle for the last 5 s", "before the last third"),
    )
    rows = []
    for name, words in KINDS.items():
        if name not in results:
            continue
        result = results[name]
        summary, seeds = result["summary"], result["settings"]["seeds"]
        rows.append(
            (
                words,
                f"{seeds[0]}:{seeds[1]}",
                str(summary["duels"]),
                _share(summary["outcomes"]["completed"]),
                _share(summary["on_the_circle"]),
                _share(summary["on_the_circle_in_time"]),
            )
        )
    return table(head, rows)


def spreads(result: Result) -> str:
    """List values of one kind of duel: mean, interval, range, worst."""
    head = ("what", "theory", "mean", "95 % of it", "least", "greatest")
    rows = []
    for key, row in result["summary"]["figures"].items():
        words, digits = words_of(key)
        rows.append(
            (
                words,
                number(row["theory"], digits),
                number(row["mean"], digits),
                interval(row["mean_low"], row["mean_high"], digits),
                number(row["least"], digits),
                f"{number(row['greatest'], digits)}",
            )
        )
    return table(head, rows)


def certified(results: Mapping[str, Result]) -> str:
    """Compare closest approaches with the template's certificate."""
    head = (
        "body",
        "starts certified",
        "nearer than certified",
        "median excess [m]",
        "least excess [m]",
        "its seed",
    )
    rows = []
    for name, words in KINDS.items():
        if name not in results:
            continue
        row = results[name]["summary"]["certificate"]
        rows.append(
            (
                words,
                _share(row["certified"]),
                _share(row["nearer_than_certified"]),
                number(row["median_excess_m"]),
                number(row["least_excess_m"]),
                str(row["worst_seed"]),
            )
        )
    return table(head, rows)


def _share(found: Mapping[str, Any]) -> str:
    ends = 100.0 * found["low"], 100.0 * found["high"]
    return f"{found['number']} of {found['of']} ({interval(*ends, 1)} %)"
