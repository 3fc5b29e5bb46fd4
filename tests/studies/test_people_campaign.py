"""Campaigns of people who come, without a single walk."""

from math import atan2, degrees, pi
from pathlib import Path
from typing import Any

import pytest

from legs_robot import nao_on_legs
from stepaside.core.poses import wrap_angle
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.policy.legs_settings import LegsSettings
from stepaside.planning import PRESETS
from stepaside.studies import person_encounters as study
from stepaside.studies.people_campaign import people_study
from stepaside.studies.people_statistics import (
    passing_rows,
    people_rows,
)
from stepaside.studies.person_encounters import (
    Encounter,
    base_settings,
    encounters,
)

WALK = WalkSettings(seed=3, gait=PRESETS["fast"])
BASE = base_settings(WALK)
FEW: dict[str, Any] = {"speeds": (0.5, 1.0), "bearings": (0, -90)}


def grid(walk: WalkSettings = WALK, seeds: int = 2) -> list[Encounter]:
    """People at two speeds from two directions, aimed at and passing."""
    offsets = (0.0, 1.2)
    return list(
        encounters(
            base_settings(walk),
            ("ideal",),
            range(walk.seed, walk.seed + seeds),
            offsets=offsets,
            **FEW,
        )
    )


def record(**changes: Any) -> dict[str, Any]:
    """Record of a person who passed by."""
    return {
        "outcome": "completed",
        "duration_s": 36.0,
        "triggered_at_s": 2.0,
        "triggered_at_distance_m": 4.0,
        "closest_m": 0.9,
        "theory_closest_m": 0.95,
        **changes,
    }


@pytest.mark.parametrize("speed", [0.3, 0.8, 1.4])
def test_people_of_any_speed_leave_the_same_time_before_evasion(
    speed: float,
) -> None:
    """The robot stands for 1.5 s before the time to contact is reached."""
    (each,) = encounters(
        BASE, ("ideal",), (WALK.seed,), speeds=(speed,), bearings=(0,),
        offsets=(0.0,),
    )  # fmt: skip
    start, strategy = each.settings.start, each.settings.strategy
    assert start.distance is not None
    until_contact = (start.distance - strategy.clearance) / speed
    assert until_contact - strategy.contact_time == pytest.approx(1.5)


@pytest.mark.parametrize("bearing", [0, 45, -90, 180])
def test_people_approach_from_their_bearing(bearing: int) -> None:
    (each,) = encounters(
        BASE,
        ("ideal",),
        (WALK.seed,),
        speeds=(0.8,),
        bearings=(bearing,),
        offsets=(0.3,),
    )
    settings = each.settings
    start = settings.start
    assert start.distance is not None and start.evader_offset is not None
    heads = pi + start.evader_offset  # as the duel stands it
    seen = wrap_angle(atan2(0.0, -start.distance) - heads)
    assert abs(wrap_angle(seen - bearing * pi / 180.0)) < 1e-9, degrees(seen)
    assert settings.person.miss == 0.3 and settings.person.speed == 0.8
    assert settings.gait == PRESETS["fast"] and settings.seed == 3
    # Far enough to stand for a while before the time to contact begins.
    strategy = settings.strategy
    away = start.distance - strategy.clearance
    assert away / 0.8 > strategy.contact_time + 1.0
    assert strategy.trigger == "time"
    # Time enough to walk past the robot, and as far again as is asked.
    way = settings.duration * 0.8
    assert way == pytest.approx(start.distance + study.PAST)


def results_of(
    records: dict[str, dict[str, Any]],
) -> list[tuple[Encounter, dict[str, Any]]]:
    """Encounters of the grid that have a record."""
    return [(e, records[e.key]) for e in grid() if e.key in records]


def test_evading_people_who_pass_is_a_false_trigger() -> None:
    results = {
        each.key: record(triggered_at_s=None if each.passes else 2.0)
        for each in grid()
    }
    (row,) = passing_rows(results_of(results))
    assert (row["number"], row["false_triggers"]) == (8, 0)
    passing = [each for each in grid() if each.passes]
    for each in passing[:2]:
        results[each.key] = record()
    (row,) = passing_rows(results_of(results))
    assert row["hours"] == pytest.approx(8 * 36.0 / 3600.0)
    assert row["false_triggers_per_hour"] == pytest.approx(2 / 0.08)


def test_robots_on_learned_legs_step_aside_of_people_all_around(
    tmp_path: Path,
) -> None:
    pytest.importorskip("onnxruntime")
    folder = nao_on_legs(tmp_path / "nao")
    legs = LegsSettings(str(folder / "policy.onnx"))
    walk = WalkSettings(robot=str(folder))
    base = base_settings(walk, legs)
    each = list(encounters(base, ("ideal",), (1,)))
    assert {e.speed for e in each} == {0.5, 1.0, 1.4, 1.8}
    assert len({e.bearing for e in each if not e.passes}) == 12
    settings = each[0].settings
    assert settings.resolved().evader_strategy == "step-aside"
    assert settings.legs == legs
    assert settings.gait.speed == 0.5
    (seen,) = encounters(
        *(base, ("cameras",), (1,)),
        speeds=(1.0,),
        bearings=(0,),
        offsets=(0.0,),
    )
    assert seen.settings.sensing == "cameras"
    assert people_study([seen]).measure_together is not None
    (row,) = people_rows([(each[0], record())])
    assert row["theory_room_m"] is None
