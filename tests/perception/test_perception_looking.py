"""Test the gaze, and the tracks meanwhile."""

import pytest

from stepaside.perception.gaze import MAX_YAW, SCAN_SPEED, RoomScan
from synthetic_cameras import TICK, Eyes


@pytest.fixture
def eyes() -> Eyes:
    made = Eyes()
    made.see(0.0)
    return made


def test_a_robot_with_a_map_scans_the_room_first() -> None:
    """Until then it gives no sighting, so that the robot stands."""
    eyes, yaws = Eyes(scan=RoomScan(behind=False)), []
    eyes.perception.head.start()
    head = eyes.perception.head
    for tick in range(round(8.0 / TICK)):
        now = tick * TICK
        eyes.tracks.clear()
        if tick:
            eyes.know(*eyes.beside(1.5, 0.0), time=now)
        seen = eyes.see(now)
        yaws.append(head.yaw)
        if seen is not None:
            break
    assert min(yaws) < -MAX_YAW + 0.01 and max(yaws) > MAX_YAW - 0.01
    assert now == pytest.approx(3.0 * MAX_YAW / SCAN_SPEED, abs=0.1)
    assert head.is_ready and not eyes.perception.searching
