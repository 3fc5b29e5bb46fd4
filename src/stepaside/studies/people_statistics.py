"""What a campaign of people came to: contacts, room, false alarms."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from math import pi

from ..planning import GaitSettings
from ..theory.unicycle.side_step import side_clearance
from .people_campaign import Encounter, Record
from .survival import wilson

SEEN_AT = 3.5  # distance at which a depth camera sees people, in [m]


def people_rows(
    grid: Sequence[Encounter], results: Mapping[str, Record]
) -> list[Record]:
    """Those who come at the robot, by what sees them and how fast they are.

    Args:
        grid: Who comes.
        results: What happened, by key.

    Returns:
        Number, contacts with their 95 % interval, falls, least and mean
        closest approach, the least that the template reaches, when evasion
        began, and theory's room for somebody seen at 3.5 m.
    """
    groups: dict[tuple[str, float], list[Record]] = defaultdict(list)
    for each in grid:
        if each.key in results and not each.passes:
            groups[each.sensing, each.speed].append(results[each.key])
    gait = grid[0].base.gait if grid else GaitSettings()
    rows = []
    for (sensing, speed), found in groups.items():
        contacts = sum(row["outcome"] == "contact" for row in found)
        closest = [row["closest_m"] for row in found]
        begun = [
            row["triggered_at_distance_m"]
            for row in found
            if row["triggered_at_distance_m"] is not None
        ]
        theory = [
            row["theory_closest_m"]
            for row in found
            if row["theory_closest_m"] is not None
        ]
        low, high = wilson(contacts, len(found))
        rows.append(
            {
                "sensing": sensing,
                "speed_m_s": speed,
                "number": len(found),
                "contacts": contacts,
                "contacts_low": low,
                "contacts_high": high,
                "falls": sum(row["outcome"] == "fall" for row in found),
                "closest_m": min(closest),
                "mean_closest_m": sum(closest) / len(closest),
                "template_closest_m": min(theory, default=None),
                "triggered": len(begun),
                "triggered_at_m": sum(begun) / len(begun) if begun else None,
                "theory_room_m": theory_room(gait, speed),
            }
        )
    return rows


def passing_rows(
    grid: Sequence[Encounter], results: Mapping[str, Record]
) -> list[Record]:
    """Those who only pass: how often the robot moved for nothing.

    Args:
        grid: Who comes.
        results: What happened, by key.

    Returns:
        Number, false triggers, time, and false triggers an hour.
    """
    groups: dict[str, list[Record]] = defaultdict(list)
    for each in grid:
        if each.key in results and each.passes:
            groups[each.sensing].append(results[each.key])
    rows = []
    for sensing, found in groups.items():
        false = sum(row["triggered_at_s"] is not None for row in found)
        hours = sum(row["duration_s"] for row in found) / 3600.0
        rows.append(
            {
                "sensing": sensing,
                "number": len(found),
                "false_triggers": false,
                "hours": hours,
                "false_triggers_per_hour": false / hours,
                "contacts": sum(r["outcome"] == "contact" for r in found),
            }
        )
    return rows


def origin_rows(
    grid: Sequence[Encounter], results: Mapping[str, Record]
) -> list[Record]:
    """How near people came, by where they came from and how fast."""
    groups: dict[tuple[str, float, int], list[Record]] = defaultdict(list)
    for each in grid:
        if each.key in results and not each.passes:
            group = each.sensing, each.speed, each.bearing
            groups[group].append(results[each.key])
    return [
        {
            "sensing": sensing,
            "speed_m_s": speed,
            "bearing_deg": bearing,
            "closest_m": min(row["closest_m"] for row in found),
            "contacts": sum(row["outcome"] == "contact" for row in found),
            "number": len(found),
        }
        for (sensing, speed, bearing), found in groups.items()
    ]


def theory_room(gait: GaitSettings, speed: float) -> float:
    """Theory's room beside somebody who is seen at 3.5 m, in [m].

    Args:
        gait: Of the robot.
        speed: Of the person, in [m/s].
    """
    pace = gait.path_interval / gait.step_duration
    return side_clearance(
        gait.speed * pace,
        0.5 * pi * gait.gain * pace,
        person_speed=speed,
        distance=SEEN_AT,
        first_step=gait.start_support,
    )
