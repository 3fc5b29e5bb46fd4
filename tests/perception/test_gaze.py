"""Test the head: within its ranges and speed, and all about in a search."""

from math import atan2, degrees, hypot, radians

import numpy as np
import pytest

from stepaside.perception.gaze import (
    FOLLOW_SPEED,
    MAX_TURN,
    MAX_UPWARD,
    MAX_YAW,
    PERSON_TOP,
    GazeTarget,
    Glances,
    HeadControl,
)
from stepaside.robots.description import load_robot
from stepaside.robots.head import load_head
from stepaside.robots.robot_tree import NAO_SIZE

TICK = 0.004
CAMERA_HEIGHT = 0.5  # of a NAO, in [m]
COUPLING = load_head(load_robot("nao")).pitch_limits


def at(bearing: float, distance: float, height: float = 0.0) -> GazeTarget:
    return GazeTarget(bearing, distance, height, CAMERA_HEIGHT)


def within(gaze: HeadControl) -> bool:
    yaws, low, high = COUPLING
    return bool(
        yaws[0] <= gaze.yaw <= yaws[-1]
        and np.interp(gaze.yaw, yaws, low) - 1e-9 <= gaze.pitch
        and gaze.pitch <= np.interp(gaze.yaw, yaws, high) + 1e-9
    )


def test_it_reaches_what_it_follows() -> None:
    gaze = HeadControl(COUPLING, TICK, NAO_SIZE)
    for _ in range(250):
        gaze.follow(at(radians(-45.0), 0.9))
    assert degrees(gaze.yaw) == pytest.approx(-45.0, abs=0.1)
    assert degrees(gaze.pitch) == pytest.approx(12.8, abs=0.2)
    assert not gaze.searching


@pytest.mark.parametrize("bearing", [-170.0, -100.0, 0.0, 88.0, 150.0])
def test_it_keeps_to_ranges_and_speed(bearing: float) -> None:
    """Close by it would nod beyond what the shells allow at that yaw."""
    gaze = HeadControl(COUPLING, TICK, NAO_SIZE)
    for _ in range(500):
        yaw, pitch = gaze.yaw, gaze.pitch
        gaze.follow(at(radians(bearing), 0.2))
        assert within(gaze)
        assert (
            hypot(gaze.yaw - yaw, gaze.pitch - pitch)
            <= 2 * FOLLOW_SPEED * TICK
        )


def test_a_search_looks_everywhere_it_can() -> None:
    gaze = HeadControl(COUPLING, TICK, NAO_SIZE)
    seen = []
    for _ in range(round(8.0 / TICK)):
        gaze.search()
        assert within(gaze)
        seen.append(degrees(gaze.yaw))
    assert gaze.searching
    assert min(seen) < -110.0
    assert max(seen) > 110.0


def settled(bearing: float, distance: float) -> HeadControl:
    gaze = HeadControl(COUPLING, TICK, NAO_SIZE)
    for _ in range(500):
        gaze.follow(at(bearing, distance))
    return gaze


def test_it_holds_the_trim_of_a_robot_in_view() -> None:
    """All of it from 0.65 m on; nearer, first the knees, then the shoulders.

    Half of NAO's view is 23.8 degrees.
    """
    low, high = NAO_SIZE.trim
    for distance in (0.4, 0.55, 0.65, 1.0, 3.0):
        pitch = degrees(settled(0.2, distance).pitch)
        away = distance - 0.06  # trim stands in front of the axis
        below = degrees(atan2(CAMERA_HEIGHT - low, away)) - pitch
        above = degrees(atan2(high - CAMERA_HEIGHT, away)) + pitch
        shoulders = degrees(atan2(0.46 - CAMERA_HEIGHT, away)) + pitch
        assert shoulders < 23.8
        assert (below < 23.8) == (distance > 0.5)
        assert (above < 23.8) == (distance > 0.6)
        assert distance < 1.0 or above == pytest.approx(below)


def pitch_at(distance: float, height: float) -> float:
    """Pitch towards something after a second, in [deg]."""
    gaze = HeadControl(COUPLING, TICK, NAO_SIZE)
    for _ in range(250):
        gaze.follow(at(0.0, distance, height))
    return degrees(gaze.pitch)


def test_it_looks_up_as_a_tall_person_comes_near() -> None:
    """To the hips, which join two legs; the floor stays in view, too."""
    pitches = [pitch_at(away, 1.5) for away in (3.0, 2.0, 1.0, 0.6, 0.4)]
    assert pitches == sorted(pitches, reverse=True)
    assert pitches[-1] == pytest.approx(-degrees(MAX_UPWARD))
    # From 1 m the hips are in the upper half of the view of 40 degrees.
    hips = degrees(atan2(PERSON_TOP - CAMERA_HEIGHT, 0.94))
    assert hips + pitches[2] == pytest.approx(20.0, abs=0.1)
    # A robot is looked at as ever.
    assert pitch_at(0.6, 0.6) == pitch_at(0.6, 0.0) > 0.0


def seen_sides(bearing: float, seconds: float = 9.0) -> set[float]:
    """Shoulders over which it looks while a person is at a bearing."""
    glances = Glances(TICK, 2.0)
    looks = {
        glances.direction(bearing, 1.0) for _ in range(round(seconds / TICK))
    }
    return looks - {bearing}


def test_glances_go_over_both_shoulders_of_who_walks_backward() -> None:
    assert seen_sides(0.0, 2.5) == {MAX_YAW}
    assert seen_sides(0.0) == seen_sides(0.1) == {MAX_YAW, -MAX_YAW}


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_gaze_never_turns_so_far_that_the_opponent_is_lost(
    side: float,
) -> None:
    """A person on one side leaves only the shoulder of that side."""
    assert seen_sides(side * 1.2) == {side * MAX_YAW}
    assert abs(MAX_YAW + 1.2) > MAX_TURN > abs(MAX_YAW - 1.2)
