"""Test the head: within its ranges and speed, and all about in a search."""

from math import degrees, hypot, radians

import numpy as np
import pytest

from stepaside.robots.description import load_robot
from stepaside.robots.head import load_head
from stepaside.sensing.gaze import SPEED, Gaze

TICK = 0.004
COUPLING = load_head(load_robot("nao")).coupling


def within(gaze: Gaze) -> bool:
    yaws, low, high = COUPLING
    return bool(
        yaws[0] <= gaze.yaw <= yaws[-1]
        and np.interp(gaze.yaw, yaws, low) - 1e-9 <= gaze.pitch
        and gaze.pitch <= np.interp(gaze.yaw, yaws, high) + 1e-9
    )


def test_it_reaches_what_it_follows() -> None:
    gaze = Gaze(COUPLING, TICK)
    for _ in range(250):
        gaze.follow(radians(-45.0), 0.9)
    assert degrees(gaze.yaw) == pytest.approx(-45.0, abs=0.1)
    assert degrees(gaze.pitch) == pytest.approx(11.3, abs=0.2)
    assert not gaze.searching


@pytest.mark.parametrize("bearing", [-170.0, -100.0, 0.0, 88.0, 150.0])
def test_it_keeps_to_ranges_and_speed(bearing: float) -> None:
    """Close by it would nod beyond what the shells allow at that yaw."""
    gaze = Gaze(COUPLING, TICK)
    for _ in range(500):
        yaw, pitch = gaze.yaw, gaze.pitch
        gaze.follow(radians(bearing), 0.2)
        assert within(gaze)
        assert hypot(gaze.yaw - yaw, gaze.pitch - pitch) <= 2 * SPEED * TICK


def test_a_search_looks_everywhere_it_can() -> None:
    gaze = Gaze(COUPLING, TICK)
    seen = []
    for _ in range(round(8.0 / TICK)):
        gaze.search()
        assert within(gaze)
        seen.append(degrees(gaze.yaw))
    assert gaze.searching
    assert min(seen) < -110.0
    assert max(seen) > 110.0


def test_a_search_begins_where_the_other_left() -> None:
    for side in (1.0, -1.0):
        gaze = Gaze(COUPLING, TICK)
        for _ in range(20):
            gaze.follow(side * 1.0, 1.0)
        before = gaze.yaw
        gaze.search()
        assert side * (gaze.yaw - before) > 0.0
