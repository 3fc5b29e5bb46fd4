"""People who approach or chase a robot on learned legs."""

import json
from collections import defaultdict
from collections.abc import Mapping, Sequence
from statistics import median
from typing import Any

from stepaside.sim.body_settings import BODIES

from .markdown import counted, number, table

MILLISECONDS = 1e3  # per second


def seen_by(settings: Mapping[str, Any], sensing: str) -> str:
    """Return the sensors of a result in words.

    Args:
        settings: Settings of the result.
        sensing: Kind of sensing.
    """
    rear = settings.get("rear_camera", False)
    words = "cameras ahead and behind" if rear else sensing
    camera = settings.get("depth_camera", "")
    return f"{words} ({camera.upper()})" if camera else words


def body_of(settings: Mapping[str, Any]) -> str:
    """Return the body of a campaign: its preset, another delay, sensors.

    Args:
        settings: Settings of the result.
    """
    changes = json.loads(settings["changes"])
    own, words = changes.get("body"), ["ideal"]
    if own is not None:
        hardware = own.get("backlash") == BODIES["hardware"].backlash
        delay = MILLISECONDS * own["cycle"] * own["delay_cycles"]
        words = ["hardware" if hardware else settings["body"]]
        words.append(f"delay {delay:g} ms")
    (sensing,) = settings["sensings"]
    if sensing != "ideal":
        robot = changes["robot"].upper()
        words.append(f"{robot} with {seen_by(settings, sensing)}")
    return ", ".join(words)


def people(*results: Mapping[str, Any]) -> str:
    """List contacts, falls and distances by body and walking speed."""
    rows = [
        (
            body_of(result["settings"]),
            f"{row['speed_m_s']:g}",
            counted(row["contacts"], row["number"]),
            counted(row["falls"], row["number"]),
            number(row["closest_m"], 2),
            number(row["mean_closest_m"], 2),
            number(row["template_closest_m"], 2),
            number(row["triggered_at_m"], 1),
        )
        for result in results
        for row in result["people"]
    ]
    head = (
        *("body", "speed [m/s]", "touched", "fell", "closest [m]"),
        *("mean [m]", "template's closest [m]", "begun at [m]"),
    )
    return table(head, rows)


def passers_by(*results: Mapping[str, Any]) -> str:
    """List false triggers with passing pedestrians, by body."""
    return table(
        ("body", "passers-by", "false triggers", "touched"),
        [
            (
                body_of(result["settings"]),
                str(row["number"]),
                counted(row["false_triggers"], row["number"]),
                counted(row["contacts"], row["number"]),
            )
            for result in results
            for row in result["passing"]
        ],
    )


def chasers(*results: Mapping[str, Any]) -> str:
    """List chases by robot, sensing, and person.

    Each distance is the median over the directions, and the least.
    """
    rows = []
    for result in results:
        groups: dict[tuple[bool, float], list[Mapping[str, Any]]]
        groups = defaultdict(list)
        for row in result["chases"]:
            groups[row["feints"], row["turning_radius_m"]].append(row)
        for (feints, radius), found in groups.items():
            outcomes = [row["outcome"] for row in found]
            shares = [
                row["closest_m"] / row["template_closest_m"] for row in found
            ]
            rows.append(
                (
                    result["settings"]["robot"].upper(),
                    seen_by(result["settings"], result["settings"]["sensing"]),
                    "feints" if feints else "steers",
                    f"{radius:g}",
                    number(result["closed_form_m"][f"{radius:g}"], 2),
                    _middle([row["template_closest_m"] for row in found]),
                    _middle([row["closest_m"] for row in found]),
                    _middle(shares),
                    str(len(found)),
                    counted(outcomes.count("fall"), len(found)),
                )
            )
    head = (
        *("robot", "seen by", "person", "turning radius [m]", "c* [m]"),
        *("point [m]", "in physics [m]", "physics / point", "games", "fell"),
    )
    return table(head, rows)


def _middle(values: Sequence[float]) -> str:
    """Return the median and, in brackets, the least value."""
    return f"{number(median(values), 2)} ({number(min(values), 2)})"
