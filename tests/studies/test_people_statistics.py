"""Test what a campaign of people came to by laws: everybody counts."""

from statistics import fmean
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference_statistics import is_wilson
from stepaside.games.walk_settings import WalkSettings
from stepaside.studies.people_statistics import (
    origin_rows,
    passing_rows,
    people_rows,
    theory_room,
)
from stepaside.studies.person_encounters import (
    Encounter,
    base_settings,
    encounters,
)

WAY: dict[str, Any] = {
    "bearings": (0, 90),
    "offsets": (0.0, 1.2),
    "speeds": (0.5, 1.0),
}
GRID = tuple(
    encounters(
        base_settings(WalkSettings()), ("ideal", "cameras"), (1,), **WAY
    )
)
OUTCOMES = ("completed", "contact", "fall")


@st.composite
def results(draw: st.DrawFn) -> dict[str, Any]:
    """Records of some encounters of the grid."""
    each = st.floats(0.1, 9.0)
    some = st.sampled_from(GRID)
    done = draw(st.lists(some, min_size=1, unique_by=lambda one: one.key))
    found = {}
    for one in done:
        triggered = draw(st.booleans())
        found[one.key] = {
            "outcome": draw(st.sampled_from(OUTCOMES)),
            "duration_s": draw(each),
            "triggered_at_s": draw(each) if triggered else None,
            "triggered_at_distance_m": draw(each) if triggered else None,
            "closest_m": draw(each),
            "theory_closest_m": draw(st.none() | each),
        }
    return found


def pairs(found: dict[str, Any]) -> list[tuple[Encounter, dict[str, Any]]]:
    """Encounters that have a record, in the order of the grid."""
    return [(e, found[e.key]) for e in GRID if e.key in found]


def of(found: dict[str, Any], *, passes: bool, **where: Any) -> list[Any]:
    """Results of those encounters that are somehow."""

    def fits(one: Encounter) -> bool:
        return one.passes == passes and all(
            getattr(one, name) == value for name, value in where.items()
        )

    return [found[e.key] for e in GRID if e.key in found and fits(e)]


@settings(max_examples=15)
@given(results())
def test_contacts_and_distances_cover_all_approaching_people(
    found: dict[str, Any],
) -> None:
    rows = people_rows(pairs(found))
    assert sum(row["number"] for row in rows) == len(of(found, passes=False))
    for row in rows:
        where = {"sensing": row["sensing"], "speed": row["speed_m_s"]}
        own = of(found, passes=False, **where)
        ended = [r["outcome"] for r in own]
        contacts = ended.count("contact")
        assert row["number"] == len(own)
        assert (row["contacts"], row["falls"]) == (
            contacts,
            ended.count("fall"),
        )
        bounds = row["contacts_low"], row["contacts_high"]
        assert is_wilson(*bounds, contacts, len(own))
        closest = [r["closest_m"] for r in own]
        assert row["closest_m"] == min(closest)
        assert row["mean_closest_m"] == pytest.approx(fmean(closest))
        begun = [r["triggered_at_distance_m"] for r in own]
        begun = [away for away in begun if away is not None]
        assert row["triggered"] == len(begun)
        if begun:
            assert row["triggered_at_m"] == pytest.approx(fmean(begun))
        theory = [r["theory_closest_m"] for r in own]
        theory = [away for away in theory if away is not None]
        assert row["template_closest_m"] == min(theory, default=None)
        room = theory_room(GRID[0].base.gait, row["speed_m_s"])
        assert row["theory_room_m"] == room


@settings(max_examples=15)
@given(results())
def test_false_triggers_are_per_hour_of_passing_people(
    found: dict[str, Any],
) -> None:
    rows = passing_rows(pairs(found))
    assert sum(row["number"] for row in rows) == len(of(found, passes=True))
    for row in rows:
        own = of(found, passes=True, sensing=row["sensing"])
        hours = sum(r["duration_s"] for r in own) / 3600.0
        moved = sum(r["triggered_at_s"] is not None for r in own)
        assert row["false_triggers"] == moved
        assert row["hours"] == pytest.approx(hours)
        rate = row["false_triggers_per_hour"]
        assert rate == pytest.approx(moved / hours)
        ended = [r["outcome"] for r in own]
        assert row["contacts"] == ended.count("contact")


@settings(max_examples=15)
@given(results())
def test_where_people_come_from_parts_the_same_encounters(
    found: dict[str, Any],
) -> None:
    parts = origin_rows(pairs(found))
    for row in people_rows(pairs(found)):
        same = ("sensing", "speed_m_s")
        own = [p for p in parts if all(p[k] == row[k] for k in same)]
        assert sum(part["number"] for part in own) == row["number"]
        assert sum(part["contacts"] for part in own) == row["contacts"]
        assert min(part["closest_m"] for part in own) == row["closest_m"]
        for part in own:
            bearing = part["bearing_deg"]
            where = {k: part[k] for k in ("sensing",)}
            each = of(
                found,
                passes=False,
                bearing=bearing,
                speed=part["speed_m_s"],
                **where,
            )
            assert part["closest_m"] == min(r["closest_m"] for r in each)


def test_clearance_decreases_with_the_speed_of_a_person() -> None:
    gait = WalkSettings().gait
    rooms = [theory_room(gait, speed) for speed in (0.3, 0.6, 1.0, 1.4)]
    assert rooms == sorted(rooms, reverse=True)
