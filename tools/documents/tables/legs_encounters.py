"""People who approach or chase a robot on learned legs."""

import json
from collections.abc import Mapping
from typing import Any

from stepaside.sim.body_settings import BODIES

from .markdown import counted, number, table

MILLISECONDS = 1e3  # per second


def seen_by(settings: Mapping[str, Any], sensing: str) -> str:
    """Return the sensors of a result in words."""
    rear = settings.get("rear_camera", False)
    words = "cameras ahead and behind" if rear else sensing
    camera = settings.get("depth_camera", "")
    return f"{words} ({camera.upper()})" if camera else words


def body_of(settings: Mapping[str, Any]) -> str:
    """Return the body of a campaign: its preset, another delay, sensors."""
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
            number(row["triggered_at_m"], 1),
        )
        for result in results
        for row in result["people"]
    ]
    head = (
        *("body", "speed [m/s]", "touched", "fell", "closest [m]"),
        "begun at [m]",
    )
    return table(head, rows)
