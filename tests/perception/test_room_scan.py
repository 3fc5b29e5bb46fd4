"""Test the look around before a game begins."""

from math import radians

import numpy as np
import pytest

from made_up_eyes import HEAD, NAO
from made_up_robot import GAIT, FakeStrategy
from stepaside.control.scheme_builder import build_scheme
from stepaside.core.poses import Array
from stepaside.locomotion.zmp.control_settings import OPEN_LOOP
from stepaside.perception.colour_detector import RED
from stepaside.perception.floor_map import FloorMap
from stepaside.perception.gaze import Gaze
from stepaside.perception.perception import Perception
from stepaside.perception.room_scan import BEHIND, FACING, LONGEST, RoomScan
from stepaside.planning import Direction

TICK = 0.02
START = 3.0  # heading at first, near to a turn of pi, in [rad]
HALF = radians(29.0)  # of the view of the depth camera
BEGINS, RATE = 0.8, 0.46  # of a turn on the spot, in [s] and [rad/s]


def looked(
    *, behind: bool, rate: float = RATE
) -> tuple[float, Array, RoomScan]:
    """How long a look takes, in [s], and where the eyes were turned."""
    gaze, around = Gaze(HEAD.coupling, TICK), RoomScan()
    around.behind = behind
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
    """Share of the directions that were in view."""
    around = np.linspace(-np.pi, np.pi, 721)
    off = np.abs((around[:, None] - turned + np.pi) % (2.0 * np.pi) - np.pi)
    return float((off < HALF).any(axis=1).mean())


def test_a_head_alone_does_not_see_what_is_behind() -> None:
    lasted, turned, _ = looked(behind=False, rate=0.0)
    assert 1.8 < lasted < 2.3 and 0.7 < share_seen(turned) < 0.85


def test_a_body_that_turns_has_seen_all_around() -> None:
    """And faces again where it did, no later than it can."""
    lasted, turned, around = looked(behind=True)
    assert share_seen(turned) > 0.99
    way = 2.0 * BEHIND - FACING
    assert lasted == pytest.approx(BEGINS + way / RATE, abs=0.1)
    assert around.turning == 0.0
    assert share_seen(looked(behind=False)[1]) < 0.95


def test_after_turning_back_the_body_does_not_turn_again() -> None:
    gaze, around = Gaze(HEAD.coupling, TICK), RoomScan()
    around.behind = True
    headings = np.array([0.0, -0.7, -1.4, -1.4, -0.7, 0.0, 0.1])
    turnings: list[float] = []
    for heading in START + np.repeat(headings, 100):
        around.look(gaze, len(turnings) * TICK / 4, heading)
        turnings.append(around.turning)
    assert turnings == [-1.0] * 200 + [1.0] * 300 + [0.0] * 200
    assert not around.lasts(gaze)


def test_a_turn_that_does_not_come_is_not_waited_for_ever() -> None:
    lasted, turned, around = looked(behind=True, rate=0.0)
    assert lasted == pytest.approx(0.5 * LONGEST, abs=0.1)
    assert around.turning == 0.0
    assert turned.min() == pytest.approx(-radians(115.0), abs=0.01)


@pytest.mark.parametrize("rate", [0.05, 0.1, 0.2, 0.26])
def test_who_turns_slowly_turns_back_in_time(rate: float) -> None:
    """Whatever it has seen by then: a game begins as it was put."""
    gaze, around = Gaze(HEAD.coupling, TICK), RoomScan()
    around.behind, now, heading = True, 0.0, START
    while around.lasts(gaze):
        around.look(gaze, now, heading)
        now += TICK
        if now > BEGINS:
            heading += rate * around.turning * TICK
    assert now < LONGEST + 0.1
    assert abs(heading - START) < FACING + rate * BEGINS


def test_who_turns_the_wrong_way_turns_back_as_well() -> None:
    lasted, _, around = looked(behind=True, rate=-0.1)
    assert lasted == pytest.approx(LONGEST, abs=0.1)
    assert around.turning == 0.0


@pytest.mark.parametrize("awaits_start", [True, False])
def test_a_robot_that_is_ready_scans_on_until_the_start(
    awaits_start: bool,
) -> None:
    perception = Perception(
        *(NAO, HEAD, RED),
        tick=TICK,
        floor=FloorMap(),
        awaits_start=awaits_start,
    )
    assert perception.looking and not perception.is_ready
    perception._gaze.turned = 2
    assert perception.is_ready
    assert perception.looking is awaits_start
    perception.started = True
    assert not perception.looking


@pytest.mark.parametrize("direction", list(Direction))
def test_who_walks_backward_looks_behind(direction: Direction) -> None:
    """Whatever its role: only that one turns its back meanwhile."""
    perception = Perception(NAO, HEAD, RED, tick=TICK, floor=FloorMap())
    assert not perception.around.behind
    build_scheme(
        FakeStrategy(direction=direction),
        NAO,
        GAIT,
        OPEN_LOOP,
        tick=TICK,
        perception=perception,
    )
    assert perception.around.behind is (direction is Direction.BACKWARD)
