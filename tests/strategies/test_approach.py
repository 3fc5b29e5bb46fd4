"""Test closest approach and time to contact against simulated walks."""

from math import asin, cos, hypot, inf, pi, radians, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from stepaside.planning import PRESETS
from stepaside.strategies import Evasion, EvasionMemory, Knowledge, Limits
from stepaside.strategies.approach import Approach
from stepaside.strategies.knowledge import MAX_HEADING

FAST = PRESETS["fast"]
LIMITS = Limits(FAST.speed, FAST.gain, FAST.stride, FAST.step_duration)
TIMED = Evasion(trigger="time")
PLACES = st.floats(-4.0, 4.0)
SPEEDS = st.floats(-1.5, 1.5)


def coming(
    distance: float, speed: float = 1.0, bearing: float = 0.0, miss: float = 0
) -> Knowledge:
    """Return knowledge of a person who passes at a distance to the left."""
    x, y = distance * cos(bearing), distance * sin(bearing)
    aim = bearing + pi - asin(miss / distance)
    return Knowledge(
        1.0,
        bearing,
        hypot(x, y),
        LIMITS,
        velocity=(speed * cos(aim), speed * sin(aim)),
    )


@given(PLACES, PLACES, SPEEDS, SPEEDS, st.floats(0.2, 1.0))
def test_time_and_miss_are_those_of_a_walk_straight_on(
    x: float, y: float, u: float, v: float, clearance: float
) -> None:
    approach = Approach(x, y, u, v)
    assume(approach.speed > 0.1)
    times = np.linspace(0.0, 80.0, 8001)
    away = np.hypot(x + u * times, y + v * times)
    found = approach.contact_time(clearance)
    if found == inf:
        coming_near = away[1] < away[0] and away.min() < clearance - 0.02
        assert not coming_near
    elif found > 0.0:
        there = hypot(x + u * found, y + v * found)
        assert there == pytest.approx(clearance, abs=1e-6)
        before = times < found - 0.01
        assert (away[before] >= clearance - 1e-6).all()


def test_still_or_receding_opponents_never_make_contact() -> None:
    assert Approach(1.0, 0.0, 0.0, 0.0).contact_time(0.7) == inf
    assert Approach(0.3, 0.0, 0.0, 0.0).contact_time(0.7) == inf
    assert Approach(0.3, 0.0, 0.5, 0.0).contact_time(0.7) == inf
    assert Approach(0.3, 0.0, -0.5, 0.0).contact_time(0.7) == 0.0
    # The direction of approach of a slow player is its bearing.
    assert Approach(0.0, 1.0, 0.01, 0.0).origin == pytest.approx(pi / 2)
    assert abs(Approach(0.0, 1.0, 1.0, 0.0).origin) == pytest.approx(pi)


@given(st.floats(-pi, pi))
def test_a_swift_heading_corrects_the_largest_possible_error(
    error: float,
) -> None:
    share = LIMITS.gain * LIMITS.stride / LIMITS.speed
    turned = share * LIMITS.correcting_heading(error)
    most = share * MAX_HEADING
    assert turned == pytest.approx(max(-most, min(most, error)), abs=1e-12)


def test_a_side_step_gains_room_and_more_from_farther_away() -> None:
    rooms = [
        Approach(x, 0.0, -1.0, 0.0).predicted_clearance(
            LIMITS, pi / 2, stands=True
        )
        for x in (1.0, 2.0, 3.0, 4.0)
    ]
    assert rooms == sorted(rooms) and rooms[0] < 0.1 and rooms[-1] > 0.7
    # As long as theory's unicycle, but for whole steps.
    both = [
        Approach(3.0, 0.0, -1.0, 0.0).predicted_clearance(
            LIMITS, a, stands=True
        )
        for a in (pi / 2, -pi / 2)
    ]
    assert both[0] == pytest.approx(both[1])
    moving = Approach(3.0, 0.0, -1.0, 0.0).predicted_clearance(
        LIMITS, pi / 2, stands=False
    )
    assert moving > rooms[2]


@pytest.mark.parametrize("speed", [0.2, 0.6, 1.4])
def test_evasion_in_time_begins_as_early_for_everybody(speed: float) -> None:
    far, near = (
        TIMED.clearance + speed * (TIMED.contact_time + late)
        for late in (0.05, -0.05)
    )
    assert not TIMED.decide(coming(far, speed), TIMED.begin())[0].walks
    intent, memory = TIMED.decide(coming(near, speed), TIMED.begin())
    assert intent.walks and memory.evading and memory.side != 0


@pytest.mark.parametrize("bearing", [0.0, 1.0, -2.5])
def test_passing_people_do_not_trigger_evasion(bearing: float) -> None:
    for distance in (1.3, 2.0, 3.0):
        for miss in (1.2, -1.2):
            known = coming(distance, 1.0, bearing, miss)
            assert not TIMED.decide(known, TIMED.begin())[0].walks
            nearer = coming(distance, 1.0, bearing, 0.3 * miss)
            assert TIMED.decide(nearer, TIMED.begin())[0].walks


@pytest.mark.parametrize("miss", [0.3, -0.3])
@pytest.mark.parametrize("bearing", [0.0, 0.5, -0.5])
def test_it_steps_to_the_side_that_leaves_more_room(
    bearing: float, miss: float
) -> None:
    """The heading turns so that the back points there."""
    _, memory = TIMED.decide(coming(3.0, 1.0, bearing, miss), TIMED.begin())
    room = {
        side: Approach.of(coming(3.0, 1.0, bearing, miss)).predicted_clearance(
            LIMITS,
            Approach.of(coming(3.0, 1.0, bearing, miss)).origin
            + side * pi / 2,
            stands=True,
        )
        for side in (1, -1)
    }
    assert room[memory.side] > room[-memory.side] + 0.05
    if bearing == 0.0:  # by the left: walk backward to the right
        assert memory.side == (1 if miss > 0.0 else -1)


def test_the_side_stays_until_standing_is_safe() -> None:
    begun = EvasionMemory(True, -1)
    for miss in (0.3, -0.3):
        _, memory = TIMED.decide(coming(2.0, 1.0, 0.1, miss), begun)
        assert memory == begun
    # Past, and past again: at the second step it comes to rest.
    away = Knowledge(1.0, 0.3, 1.0, LIMITS, velocity=(0.8, 0.3))
    intent, once = TIMED.decide(away, begun)
    assert intent.walks and once.safe == 1
    intent, twice = TIMED.decide(away, once)
    assert not intent.walks and twice == EvasionMemory()
    # Who comes again in between is not safe yet.
    assert TIMED.decide(coming(2.0), once)[1].safe == 0


@pytest.mark.parametrize("angle", [0.0, radians(45.0), pi / 2])
def test_the_angle_refers_to_the_opponents_direction_of_approach(
    angle: float,
) -> None:
    strategy = Evasion(angle=angle, trigger="time")
    intent, memory = strategy.decide(coming(2.0, 1.0, 0.02), strategy.begin())
    share = LIMITS.gain * LIMITS.stride / LIMITS.speed
    wanted = 0.02 + memory.side * angle
    turned = max(-share * MAX_HEADING, min(share * MAX_HEADING, wanted))
    assert share * intent.heading == pytest.approx(turned, abs=1e-6)
