"""Campaigns of people who come, without a single walk."""

import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from math import atan2, degrees, hypot, pi, sin
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from legs_robot import nao_on_legs
from stepaside.cli.main import main
from stepaside.core import worker_pool as pools
from stepaside.core.poses import Pose, wrap_angle
from stepaside.games.duel_evaluation import template_closest_approach
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.policy.legs_settings import LegsSettings
from stepaside.planning import PRESETS
from stepaside.report.people_figure import draw_people
from stepaside.sim.person_motion import PersonMotion
from stepaside.studies import people_campaign as campaign
from stepaside.studies import person_encounters as study
from stepaside.studies.campaign import CodeStamp, run_study
from stepaside.studies.drawn_encounters import drawn_study
from stepaside.studies.people_campaign import people_study
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
from stepaside.studies.result_files import read_result
from stepaside.studies.result_store import ResultStore

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


def test_keys_tell_everything_apart() -> None:
    other = replace(WALK, gait=PRESETS["nao"])
    keys = {each.key for each in (*grid(), *grid(other))}
    assert len(keys) == 2 * len(grid()) == 32
    assert keys >= {each.key for each in grid(seeds=1)}


def test_recorded_encounters_are_not_repeated(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    met: list[str] = []

    def play(each: Encounter) -> dict[str, Any]:
        met.append(each.key)
        return record(closest_m=each.speed)

    monkeypatch.setattr(campaign, "play_encounter", play)
    store = ResultStore(tmp_path)
    first = run_study(people_study(grid(seeds=1)), store)
    again = run_study(people_study(grid(seeds=2)), store)
    assert len(first) == 8 and again.reused == 8
    assert len(again) == 16 == len(met) and len(set(met)) == 16
    other = CodeStamp("another", {})
    monkeypatch.setattr(campaign, "code_stamp", lambda *_: other)
    run_study(people_study(grid(seeds=1)), store)
    assert len(met) == 24


def results_of(
    records: dict[str, dict[str, Any]],
) -> list[tuple[Encounter, dict[str, Any]]]:
    """Encounters of the grid that have a record."""
    return [(e, records[e.key]) for e in grid() if e.key in records]


def test_contacts_and_clearance_are_tabulated_by_speed() -> None:
    results = {each.key: record() for each in grid()}
    touched = next(e for e in grid() if e.speed == 1.0 and not e.passes)
    results[touched.key] = record(outcome="contact", closest_m=0.3)
    slow, quick = people_rows(results_of(results))
    assert (slow["speed_m_s"], slow["number"], slow["contacts"]) == (0.5, 4, 0)
    assert (quick["contacts"], quick["closest_m"]) == (1, 0.3)
    assert quick["mean_closest_m"] == pytest.approx((0.3 + 3 * 0.9) / 4)
    assert quick["contacts_low"] < 0.25 < quick["contacts_high"]
    assert quick["triggered_at_m"] == 4.0 and quick["triggered"] == 4
    assert quick["theory_room_m"] == theory_room(PRESETS["fast"], 1.0) > 0.1
    origins = origin_rows(results_of(results))
    assert len(origins) == 4
    assert sum(row["contacts"] for row in origins) == 1
    half = {e.key: results[e.key] for e in grid() if e.speed == 0.5}
    assert len(people_rows(results_of(half))) == 1


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


def test_the_map_has_a_point_for_each_direction(tmp_path: Path) -> None:
    results = {each.key: record() for each in grid()}
    draw_people(origin_rows(results_of(results)), 0.7, tmp_path / "map.png")
    assert (tmp_path / "map.png").read_bytes()[:4] == b"\x89PNG"


def test_the_command_writes_table_and_map(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(campaign, "play_encounter", lambda each: record())
    monkeypatch.setattr(pools, "worker_pool", ThreadPoolExecutor)
    line = "robustness --kind person --gait fast --seeds 1 --workers 1"
    told = CliRunner().invoke(
        main, [*line.split(), "--output", str(tmp_path / "found")]
    )
    assert told.exit_code == 0, told.output
    assert "0/15" in told.stdout and "0.90 m" in told.stdout
    made = read_result(tmp_path / "found" / "people.json")
    assert made["planned"] == made["done"] == 80 + 9 * 20
    assert {row["reaction"] for row in made["reactions"]} == set(study.LADDER)
    assert {row["speed_m_s"] for row in made["people"]} == set(study.SPEEDS)
    assert not (tmp_path / "found" / "survival.json").exists()
    assert (tmp_path / "found" / "people.png").exists()
    asked = CliRunner().invoke(main, [*line.split(), "--json"])
    assert json.loads(asked.stdout)["person"]["passers_by"][0]["number"] == 20


def test_people_who_turn_head_for_the_robot_at_the_given_distance() -> None:
    for speed in (0.5, 1.4):
        for bearing in (0, 180):
            (each,) = encounters(
                BASE, ("ideal",), (WALK.seed,), speeds=(speed,),
                bearings=(bearing,), reactions=("turning",),
            )  # fmt: skip
            settings = each.settings
            distance = settings.start.distance
            assert distance is not None and not each.passes
            motion = PersonMotion(
                settings.person, Pose(0.0, 0.0, 0.0), (distance, 0.0)
            )
            aside = []
            for i in range(round((distance + 0.5) / speed / 0.01)):
                motion.advance(0.01 * (i + 1), 0.01, (distance, 0.0))
                x, y, course = motion.pose
                gap = hypot(x - distance, y)
                sight = wrap_angle(course - atan2(-y, distance - x))
                aside.append((gap, abs(sight)))
            # It would have passed at 1.2 m, and comes straight to the robot.
            before = [gap * sin(sight) for gap, sight in aside if gap > 1.65]
            assert before[-1] == pytest.approx(1.2, abs=0.1)
            assert all(s < 0.02 for gap, s in aside if 0.5 < gap < 1.55)
            assert min(aside)[0] < 0.05


def test_half_of_the_drawn_people_are_found_hard_by_a_search() -> None:
    base = base_settings(WALK)
    short = drawn_study(base, "ideal", 4).cases
    longer = drawn_study(base, "ideal", 40).cases
    assert [each.key for each in short] == [e.key for e in longer[:4]]
    assert len({each.key for each in longer}) == 40
    assert {each.reaction for each in longer} == set(study.LADDER)
    easy, hard = (
        template_closest_approach(each.encounter().settings)
        for each in short[:2]
    )
    assert easy is not None and hard is not None and hard < easy
    assert short[1].is_hard and short[1].encounter() == short[1].encounter()


def test_a_robot_that_sees_stands_far_from_walls() -> None:
    """A wall beside it would be the nearest thing to look at."""
    for sensing in ("ideal", "cameras"):
        for each in encounters(BASE, (sensing,), (1,)):
            room, distance = each.settings.room, each.settings.start.distance
            assert distance is not None
            if sensing == "ideal":
                assert room == each.base.room
            else:
                assert room.walls > distance + study.PAST


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
