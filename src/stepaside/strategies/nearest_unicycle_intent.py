"""Nearest intent of a unicycle to a body velocity."""

from dataclasses import replace
from math import atan2, cos, hypot, pi

from ..core.poses import wrap_angle
from ..planning import Direction
from .knowledge import ON_THE_SPOT, STAND, Intent, Limits


def unicycle_intent(
    intent: Intent, limits: Limits, direction: Direction
) -> Intent:
    """Return the intent of a unicycle that is nearest to a body velocity.

    A unicycle has no lateral velocity: it turns its direction of driving to
    that of the horizontal velocity, and meanwhile drives at the component of
    the velocity along it, the nearest speed that it has; where that component
    is negative it turns on the spot. The desired turning rate counts where
    no horizontal velocity is desired.

    Args:
        intent: An intent; one without a velocity is returned.
        limits: Limits of the gait.
        direction: Whether the unicycle drives forward or backward.

    Returns:
        Intent with a heading and a speed factor.
    """
    if intent.velocity is None:
        return intent
    if not intent.walks:
        return STAND
    ahead, left, turn = intent.velocity
    speed = hypot(ahead, left)
    if speed == 0.0:
        heading = min(max(turn / limits.gain, -pi), pi)
        return replace(
            intent, heading=heading, speed_factor=ON_THE_SPOT, velocity=None
        )
    reverse = 0.0 if direction is Direction.FORWARD else pi
    heading = wrap_angle(atan2(left, ahead) + reverse)
    share = speed * cos(heading) / limits.speed
    return replace(
        intent,
        heading=heading,
        speed_factor=min(max(share, ON_THE_SPOT), 1.0),
        velocity=None,
    )
