"""Test moving boxes: motion, files, simulation, map and replay."""

from dataclasses import replace
from math import hypot
from typing import Any

import numpy as np
import pytest

from stepaside.arena import MovingBox, Room, check_initial_poses
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.games import duel
from stepaside.locomotion.guard import AHEAD, KnownRoom
from stepaside.perception.measurement import RobotState
from stepaside.robots.leg_kinematics import BodyReference

BOX = MovingBox(0.2, -0.9, 0.3, 0.2, (0.5, 0.6), 0.1, 0.4)
ROOM = Room(
    3.0,
    3.0,
    moving=(BOX,),
    starts=(Pose(-1.1, 0.0, 0.0), Pose(-0.4, 0.3, 3.1)),
)
HALF = BOX.length / BOX.speed  # time from one end to the other, in [s]


def test_box_moves_along_a_line_at_its_speed_and_returns() -> None:
    assert BOX.place_at(0.0) == pytest.approx((0.2, -0.9))
    assert BOX.place_at(HALF) == pytest.approx((0.5, 0.6))
    for time in np.linspace(0.0, 2.0 * HALF, 23).tolist():
        x, y = BOX.place_at(time)
        assert BOX.place_at(2.0 * HALF - time) == pytest.approx((x, y))
        assert BOX.place_at(time + 6.0 * HALF) == pytest.approx((x, y))
        u, v = BOX.place_at(time + 1e-4)
        assert hypot(u - x, v - y) == pytest.approx(1e-5, rel=1e-6)
        assert (x - 0.2) * 1.5 - (y + 0.9) * 0.3 == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("begin", "end"),
    [(0.0, 0.0), (1.0, 4.0), (HALF - 1, HALF + 2), (0.5, 5 * HALF)],
)
def test_swept_floor_contains_the_box_at_all_times(
    begin: float, end: float
) -> None:
    """Also with turning points in between."""
    swept = BOX.swept(begin, end)
    corners = []
    for time in np.linspace(begin, end, 301).tolist():
        corners.append(BOX.at(time).points)
        assert swept.clearance(corners[-1]).max() < 1e-9
    farthest = np.concatenate(corners)
    for corner in swept.points:  # the hull is tight
        assert np.hypot(*(farthest - corner).T).min() < 0.02


def test_box_stays_between_the_walls_and_off_the_initial_poses() -> None:
    with pytest.raises(ConfigurationError, match="between the walls"):
        Room(3.0, 3.0, moving=(MovingBox(0, 0, 0.2, 0.2, (1.6, 0)),))
    with pytest.raises(ConfigurationError, match="room.moving must be empty"):
        replace(duel(level="steps"), room=ROOM)
    assert ROOM.starts is not None
    check_initial_poses(ROOM, ROOM.starts)
    on_it = Pose(0.2, -0.7, 0.0), ROOM.starts[1]
    with pytest.raises(ConfigurationError, match="pursuer must start"):
        check_initial_poses(ROOM, on_it)


def test_given_map_covers_the_floor_swept_in_the_near_future() -> None:
    around, nothing = KnownRoom(ROOM, Pose(0.0, 0.0, 0.0)), np.zeros(3)
    body: Any = BodyReference
    for now in (0.0, 1.0, 5.0):
        measurement = RobotState(
            now, nothing, nothing, nothing, np.zeros(8), None
        )
        around.note(measurement, body)
        known = around.solids.shapes[-1]
        for ahead in (0.0, 0.5 * AHEAD, AHEAD):
            corners = BOX.at(now + ahead).points
            assert known.clearance(corners).max() < 1e-9
        far = BOX.at(now + AHEAD + 8.0).points.mean(axis=0)
        assert known.clearance([far])[0] > 0.1
