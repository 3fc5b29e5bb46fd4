"""Test the scan of the room before a game."""

from math import radians

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.perception.gaze import (
    BODY_TURN,
    HEADING_TOLERANCE,
    MAX_DURATION,
    HeadControl,
    RoomScan,
)
from stepaside.robots.robot_tree import NAO_SIZE
from synthetic_cameras import HEAD

TICK = 0.02
START = 3.0  # heading at first, near to a turn of pi, in [rad]
HALF = radians(29.0)  # of the view of the depth camera
BEGINS, RATE = 0.8, 0.46  # of a turn on the spot, in [s] and [rad/s]


def looked(
    *, behind: bool, rate: float = RATE
) -> tuple[float, Array, RoomScan]:
    """Return the duration of a scan, in [s], and the directions."""
    gaze, around = (
        HeadControl(HEAD.pitch_limits, TICK, NAO_SIZE),
        RoomScan(behind=behind),
    )
    now, heading, turned = 0.0, 0.0, []
    while around.lasts(gaze):
        around.look(gaze, now, START + heading)
        turned.append(heading + gaze.yaw)
        now += TICK
        if now > BEGINS:
            heading += rate * around.turning * TICK
        assert now < 60.0
    return now, np.array(turned), around


def share_seen(turned: Array) -> float:
    """Return the fraction of directions that were in view."""
    around = np.linspace(-np.pi, np.pi, 721)
    off = np.abs((around[:, None] - turned + np.pi) % (2.0 * np.pi) - np.pi)
    return float((off < HALF).any(axis=1).mean())


def test_the_head_alone_does_not_cover_the_rear() -> None:
    lasted, turned, _ = looked(behind=False, rate=0.0)
    assert 1.8 < lasted < 2.3 and 0.7 < share_seen(turned) < 0.85


def test_a_turning_body_covers_all_directions() -> None:
    """And turns back to its first heading."""
    lasted, turned, around = looked(behind=True)
    assert share_seen(turned) > 0.99
    way = 2.0 * BODY_TURN - HEADING_TOLERANCE
    assert lasted == pytest.approx(BEGINS + way / RATE, abs=0.1)
    assert around.turning == 0.0
    assert share_seen(looked(behind=False)[1]) < 0.95


def test_a_scan_times_out_without_a_turn() -> None:
    lasted, turned, around = looked(behind=True, rate=0.0)
    assert lasted == pytest.approx(0.5 * MAX_DURATION, abs=0.1)
    assert around.turning == 0.0
    assert turned.min() == pytest.approx(-radians(115.0), abs=0.01)


def test_a_robot_that_is_ready_scans_on_until_the_start() -> None:
    scan = RoomScan(behind=False)
    head = HeadControl(HEAD.pitch_limits, TICK, NAO_SIZE, scan=scan)
    assert head.scans and not head.is_ready
    for tick in range(round(3.0 / TICK)):
        head.move(tick * TICK, 0.0, None)
    assert head.is_ready and head.scans
    head.start()
    assert not head.scans
