"""Test body velocities of legs, and those of a unicycle in their place."""

from math import cos, hypot, pi, sin

import pytest

from stepaside.planning import Direction
from stepaside.strategies import STAND, Intent, Limits
from stepaside.strategies.strategy import unicycle_intent
from stepaside.strategies.velocity_set import STILL, BodyVelocity, VelocitySet

LEGS = VelocitySet((-0.5, 1.0), (-0.3, 0.4), (-2.0, 1.0))
LIMITS = Limits(0.1, 0.2, 0.04, 0.4)


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2, pi / 2, 2.5, -0.7, -2.0])
def test_an_oblique_velocity_ends_on_the_ellipse(angle: float) -> None:
    wanted = BodyVelocity(9.0 * cos(angle), 9.0 * sin(angle))
    ahead, left, turn = LEGS.nearest(wanted)
    assert turn == 0.0
    assert ahead * wanted.lateral == pytest.approx(left * wanted.forward)
    own = ahead / (1.0 if ahead > 0.0 else 0.5)
    side = left / (0.4 if left > 0.0 else 0.3)
    assert hypot(own, side) == pytest.approx(1.0)


def test_a_velocity_inside_is_unchanged_and_one_outside_keeps_its_curve() -> (
    None
):
    inside = BodyVelocity(0.6, 0.2, 0.9)
    assert LEGS.nearest(inside) == inside
    found = LEGS.nearest(BodyVelocity(0.5, 0.0, -4.0))
    assert found == BodyVelocity(0.25, 0.0, -2.0)


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("angle", [0.0, 0.4, -1.3, 1.8, 3.0])
def test_a_unicycle_turns_its_drive_to_the_velocity(
    direction: Direction, angle: float
) -> None:
    speed = 0.06
    velocity = BodyVelocity(speed * cos(angle), speed * sin(angle), 0.5)
    intent = unicycle_intent(Intent(velocity=velocity), LIMITS, direction)
    assert intent.velocity is None
    sign = direction.value
    driven = sign * cos(intent.heading), sign * sin(intent.heading)
    assert driven == pytest.approx((cos(angle), sin(angle)))
    # At present it drives along x only, at the component of the velocity.
    component = sign * velocity.forward / LIMITS.speed
    assert intent.speed_factor == pytest.approx(max(component, 0.05))


def test_a_unicycle_turns_on_the_spot_and_stands() -> None:
    turn = Intent(velocity=BodyVelocity(0.0, 0.0, -0.1))
    intent = unicycle_intent(turn, LIMITS, Direction.FORWARD)
    assert (intent.heading, intent.speed_factor) == (-0.5, 0.05)
    still = Intent(velocity=STILL)
    assert not still.walks
    assert unicycle_intent(still, LIMITS, Direction.FORWARD) == STAND
