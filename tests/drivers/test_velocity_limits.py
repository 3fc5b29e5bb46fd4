"""Test velocity limits, which keep the path, and the ramp."""

from dataclasses import replace
from math import inf, nan

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stepaside.core.errors import ConfigurationError
from stepaside.drivers.robot import REST, VelocityLimits
from stepaside.drivers.velocity_loop import Ramp
from stepaside.strategies.velocity_set import BodyVelocity

TIGHT = VelocityLimits(0.2, 0.1, 0.5, 0.4, 2.0)


@pytest.mark.parametrize("forward", [0.3, -0.3, 0.15, -0.05])
@pytest.mark.parametrize("turn", [0.0, 0.9, -0.2])
def test_scaled_velocities_keep_the_path_and_the_limits(
    forward: float, turn: float
) -> None:
    scaled = TIGHT.scale(BodyVelocity(forward, 0.0, turn))
    assert scaled.forward * turn == pytest.approx(scaled.turn * forward)
    assert -0.1 - 1e-12 <= scaled.forward <= 0.2 + 1e-12
    assert abs(scaled.turn) <= 0.5 + 1e-12
    assert scaled.forward * forward > 0.0
    fits = -0.1 <= forward <= 0.2 and abs(turn) <= 0.5
    assert (scaled == BodyVelocity(forward, 0.0, turn)) == fits


def test_a_robot_that_walks_sideways_keeps_its_direction() -> None:
    """Another one is commanded no lateral velocity."""
    wanted = BodyVelocity(0.2, -0.3, 0.1)
    scaled = replace(TIGHT, lateral=0.1).scale(wanted)
    assert scaled == pytest.approx((0.2 / 3, -0.1, 0.1 / 3))
    assert TIGHT.scale(wanted) == BodyVelocity(0.2, 0.0, 0.1)
    ramp = Ramp(replace(TIGHT, lateral=0.1))
    assert ramp.toward(wanted, 0.1).lateral == pytest.approx(-0.04)
    assert Ramp(TIGHT).toward(wanted, 0.1).lateral == 0.0


def test_the_ramp_climbs_at_its_accelerations_and_arrives() -> None:
    ramp, wanted = Ramp(TIGHT), BodyVelocity(0.2, 0.0, -0.3)
    speeds = [ramp.toward(wanted, 0.1) for _ in range(8)]
    assert speeds[0] == pytest.approx((0.04, 0.0, -0.2))
    assert speeds[2] == pytest.approx((0.12, 0.0, -0.3))
    assert speeds[-1] == pytest.approx(wanted)
    assert ramp.toward(REST, 0.1) == pytest.approx((0.16, 0.0, -0.1))


@pytest.mark.parametrize("bad", [nan, inf, -inf])
def test_a_velocity_that_is_not_finite_stops_at_once(bad: float) -> None:
    ramp = Ramp(TIGHT)
    ramp.toward(BodyVelocity(0.2, 0.0, 0.3), 1.0)
    assert ramp.toward(BodyVelocity(0.1, 0.0, bad), 0.1) == REST
    ramp.toward(BodyVelocity(0.2, 0.0, 0.3), 1.0)
    assert ramp.toward(BodyVelocity(bad, 0.0, 0.1), 0.1) == REST


@pytest.mark.parametrize(
    "name", "forward backward turn acceleration turn_acceleration".split()
)
@pytest.mark.parametrize("value", [0.0, -1.0, nan])
def test_a_limit_that_lets_nothing_through_is_refused(
    name: str, value: float
) -> None:
    with pytest.raises(ConfigurationError, match=f"{name} must be finite"):
        VelocityLimits(**{name: value})


@pytest.mark.parametrize("name", ["acceleration", "turn_acceleration"])
def test_an_acceleration_without_a_limit_is_refused(name: str) -> None:
    with pytest.raises(ConfigurationError, match=f"{name} must be finite"):
        VelocityLimits(**{name: inf})
    assert VelocityLimits(forward=inf).forward == inf


SPEED = st.floats(-2.0, 2.0)
WANTED = st.builds(BodyVelocity, SPEED, SPEED, SPEED)


@settings(max_examples=60)
@given(st.lists(st.tuples(WANTED, st.floats(0.0, 0.3)), max_size=12), WANTED)
def test_whatever_is_wanted_no_change_is_faster_than_the_ramp(
    wishes: list[tuple[BodyVelocity, float]], last: BodyVelocity
) -> None:
    """The ramp ends at the scaled command."""
    limits = replace(TIGHT, lateral=0.1)
    ramp = Ramp(limits)
    for wanted, passed in [*wishes, *[(last, 0.3)] * 8]:
        before, now = ramp.velocity, ramp.toward(wanted, passed)
        assert abs(now.forward - before.forward) <= 0.4 * passed + 1e-12
        assert abs(now.turn - before.turn) <= 2.0 * passed + 1e-12
        assert -0.1 - 1e-12 <= now.forward <= 0.2 + 1e-12
        assert abs(now.turn) <= 0.5 + 1e-12
        assert abs(now.lateral) <= 0.1 + 1e-12
        goal = limits.scale(wanted)
        # It goes towards its goal with each part, and never beyond.
        for own, old, aim in zip(now, before, goal, strict=True):
            assert min(old, aim) - 1e-12 <= own <= max(old, aim) + 1e-12
    assert ramp.velocity == pytest.approx(limits.scale(last))
