"""Test what the head looks at, and what is believed meanwhile."""

from math import pi
from typing import Any

import pytest

from made_up_eyes import HEAD, TICK, Eyes
from stepaside.core.poses import Pose
from stepaside.perception.floor_map import FloorMap
from stepaside.perception.gaze import MAX_YAW, SCAN_SPEED, Gaze
from stepaside.perception.measurement import Sighting
from stepaside.perception.target_selection import GAZE_RADIUS, MAX_GAZE_AGE


@pytest.fixture
def eyes() -> Eyes:
    made = Eyes()
    made.see(0.0)
    return made


@pytest.mark.parametrize(
    ("changes", "distance", "speed", "looks"),
    [
        ({}, 3.0, 0.0, True),  # the other, recognised
        ({"identified": False}, GAZE_RADIUS - 0.05, 0.0, True),  # near
        (
            {"identified": False},
            GAZE_RADIUS + 0.05,
            0.0,
            False,
        ),  # far, at rest
        ({"identified": False}, 3.0, 0.09, True),  # far, moving
        ({"identified": False}, 3.0, 0.07, False),  # hardly moving
    ],
)
def test_the_head_looks_at_what_counts(
    eyes: Eyes,
    changes: dict[str, Any],
    distance: float,
    speed: float,
    looks: bool,
) -> None:
    track = eyes.know(*eyes.beside(distance, -0.8), **changes)
    track._state[3] = speed
    eyes.see(0.0)
    assert eyes.perception.searching is not looks
    if looks:
        assert eyes.gaze.followed == pytest.approx((-0.8, distance))
    else:
        assert eyes.gaze.followed is None
    assert GAZE_RADIUS == 1.2


def test_what_is_not_confirmed_is_looked_at_only_near(eyes: Eyes) -> None:
    track = eyes.know(*eyes.beside(3.0, 0.5), identified=False)
    track.confirmed = False
    track._state[3] = 0.5
    eyes.see(0.0)
    assert eyes.perception.searching
    eyes.tracks.clear()
    near = eyes.know(*eyes.beside(1.0, 0.5), identified=False)
    near.confirmed = False
    eyes.see(0.0)
    assert eyes.gaze.followed == pytest.approx((0.5, 1.0))
    assert eyes.perception.sighting is None


def test_the_head_knows_how_tall_it_is_whom_it_looks_at(eyes: Eyes) -> None:
    track = eyes.know(*eyes.beside(1.0, 0.5))
    track.height = 1.4
    eyes.see(0.0)
    assert eyes.gaze.height == 1.4


def test_who_was_recognised_long_ago_is_a_thing_again(eyes: Eyes) -> None:
    for age, looks in (
        (MAX_GAZE_AGE - 0.1, True),
        (MAX_GAZE_AGE + 0.1, False),
    ):
        eyes.tracks.clear()
        track = eyes.know(*eyes.beside(2.0, 0.5), time=2.0)
        track.identified_at = 2.0 - age
        eyes.see(2.0)
        assert eyes.perception.searching is not looks
    assert MAX_GAZE_AGE == 1.0


def test_the_head_searches_for_who_was_not_seen_for_a_second() -> None:
    """Memory goes on, and the line of sight with it."""
    for age, looks in (
        (MAX_GAZE_AGE - 0.1, True),
        (MAX_GAZE_AGE + 0.1, False),
    ):
        eyes = Eyes()
        eyes.see(0.0)
        track = eyes.know(*eyes.beside(1.0, 0.5), time=0.0)
        track.merge(track)
        seen = eyes.see(age)
        assert isinstance(seen, Sighting)
        assert seen.bearing == pytest.approx(0.5)
        assert eyes.perception.searching is not looks
        assert (eyes.gaze.followed is not None) is looks


def test_the_one_who_counts_is_looked_at_before_others(eyes: Eyes) -> None:
    eyes.know(*eyes.beside(0.6, 1.0), identified=False)
    eyes.know(*eyes.beside(1.5, -0.5))
    seen = eyes.see(0.0)
    assert seen.bearing == pytest.approx(-0.5)
    assert eyes.gaze.followed == pytest.approx((-0.5, 1.5))


def test_a_bearing_behind_is_wrapped(eyes: Eyes) -> None:
    eyes.support = Pose(0.0, 0.0, 3.0)
    eyes.see(0.0)
    eyes.know(*eyes.beside(1.5, 2.9))
    seen = eyes.see(0.0)
    assert seen.bearing == pytest.approx(2.9)
    assert abs(seen.bearing) <= pi


def test_lost_is_lost(eyes: Eyes) -> None:
    eyes.know(*eyes.beside(1.0, 0.5))
    assert eyes.see(0.0) is not None
    assert eyes.see(10.0) is None
    assert eyes.perception.sighting is None and eyes.perception.searching


def test_who_maps_the_floor_looks_all_around_first(eyes: Eyes) -> None:
    """Until then it says nothing of the other, so that nobody walks."""
    gaze: Any = Gaze(HEAD.coupling, TICK)
    eyes.perception.floor, eyes.perception._gaze = FloorMap(), gaze
    yaws = []
    for tick in range(round(8.0 / TICK)):
        now = tick * TICK
        eyes.tracks.clear()
        eyes.know(*eyes.beside(1.5, 0.0), time=now)
        seen = eyes.see(now)
        yaws.append(gaze.yaw)
        if seen is not None:
            break
    assert min(yaws) < -MAX_YAW + 0.01 and max(yaws) > MAX_YAW - 0.01
    assert now == pytest.approx(3.0 * MAX_YAW / SCAN_SPEED, abs=0.1)
    assert gaze.scan_ends == 2 and not gaze.searching
