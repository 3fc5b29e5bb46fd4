"""Statistics of encounters with people: contacts, clearance, false alarms."""

from collections import Counter, defaultdict
from collections.abc import Iterable
from math import pi
from statistics import median

from ..planning import GaitSettings
from ..theory.unicycle.lateral_evasion import lateral_clearance
from .drawn_encounters import DrawnEncounter
from .person_encounters import Encounter
from .tabulation import Record, wilson_interval

SEEN_AT = 3.5  # distance at which a depth camera detects people, in [m]


def people_rows(
    results: Iterable[tuple[Encounter, Record]],
) -> list[Record]:
    """Tabulate people who walk straight at it, by sensing and speed.

    Args:
        results: Encounters and their records.

    Returns:
        For each row: number, contacts with their 95 % interval, falls, least
        and mean closest approach, least closest approach of the template,
        distance at which evasion began, and theoretical clearance for a
        person who is detected at 3.5 m, None for learned legs.
    """
    groups: dict[tuple[str, float], list[Record]] = defaultdict(list)
    gait, on_legs = GaitSettings(), False
    for each, record in results:
        # The same in all encounters.
        gait, on_legs = each.base.gait, each.base.legs.walks
        if not each.passes and each.reaction == "straight":
            groups[each.sensing, each.speed].append(record)
    rows = []
    for (sensing, speed), found in groups.items():
        contacts = sum(row["outcome"] == "contact" for row in found)
        closest = [row["closest_m"] for row in found]
        triggered_at = [
            row["triggered_at_distance_m"]
            for row in found
            if row["triggered_at_distance_m"] is not None
        ]
        theory = [
            row["theory_closest_m"]
            for row in found
            if row["theory_closest_m"] is not None
        ]
        low, high = wilson_interval(contacts, len(found))
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
                "triggered": len(triggered_at),
                "triggered_at_m": sum(triggered_at) / len(triggered_at)
                if triggered_at
                else None,
                "theory_room_m": None if on_legs else theory_room(gait, speed),
            }
        )
    return rows


def passing_rows(
    results: Iterable[tuple[Encounter, Record]],
) -> list[Record]:
    """Tabulate the false triggers by people who only pass.

    Args:
        results: Encounters and their records.

    Returns:
        For each kind of sensing: number, false triggers, hours, and false
        triggers per hour.
    """
    groups: dict[str, list[Record]] = defaultdict(list)
    for each, record in results:
        if each.passes:
            groups[each.sensing].append(record)
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
    results: Iterable[tuple[Encounter, Record]],
) -> list[Record]:
    """Tabulate closest approaches by sensing, speed and bearing."""
    groups: dict[tuple[str, float, float], list[Record]] = defaultdict(list)
    for each, record in results:
        if not each.passes and each.reaction == "straight":
            group = each.sensing, each.speed, each.bearing
            groups[group].append(record)
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


def reaction_rows(
    results: Iterable[tuple[Encounter | DrawnEncounter, Record]],
) -> list[Record]:
    """Tabulate what came of people, by sensing and reaction.

    Args:
        results: Encounters and their records.

    Returns:
        For each row: number, contacts with their 95 % interval, contacts of
        robots that stood, falls, causes of contacts and falls, least and
        median closest approach, in [m].
    """
    groups: dict[tuple[str, str, bool], list[Record]] = defaultdict(list)
    for each, record in results:
        hard = isinstance(each, DrawnEncounter) and each.is_hard
        if isinstance(each, DrawnEncounter) or not each.passes:
            groups[each.sensing, each.reaction, hard].append(record)
    rows = []
    for (sensing, reaction, hard), found in sorted(
        groups.items(), key=lambda item: (item[0][0], item[0][2])
    ):
        contacts = sum(row["outcome"] == "contact" for row in found)
        low, high = wilson_interval(contacts, len(found))
        closest = [row["closest_m"] for row in found]
        rows.append(
            {
                "sensing": sensing,
                "reaction": reaction,
                "hard": hard,
                "number": len(found),
                "contacts": contacts,
                "contacts_low": low,
                "contacts_high": high,
                "falls": sum(row["outcome"] == "fall" for row in found),
                "causes": dict(
                    Counter(row["cause"] for row in found if row.get("cause"))
                ),
                "closest_m": min(closest),
                "median_closest_m": median(closest),
            }
        )
    return rows


def theory_room(gait: GaitSettings, speed: float) -> float:
    """Return the theoretical clearance from a person detected at 3.5 m.

    Args:
        gait: Gait of the robot.
        speed: Speed of the person, in [m/s].

    Returns:
        Clearance, in [m].
    """
    time_scale = gait.path_interval / gait.step_duration
    return lateral_clearance(
        gait.speed * time_scale,
        0.5 * pi * gait.gain * time_scale,
        person_speed=speed,
        distance=SEEN_AT,
        first_step=gait.start_support,
    )
