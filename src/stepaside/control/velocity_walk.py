"""Velocity commands within the limits of a gait."""

from math import pi

from ..locomotion.locomotion import MotionRequest
from ..locomotion.maneuver_walk import velocity_limits
from ..planning import Direction, GaitSettings
from ..strategies.knowledge import STAND, Intent

STILL = 1e-3  # speed [m/s] or turning rate [rad/s] that counts as zero
IN_PLACE = 1e-3  # speed factor of a turn on the spot


def limit_velocity(
    forward: float, turn: float, gait: GaitSettings
) -> tuple[float, float]:
    """Limit a velocity to what a gait can walk, on the same path.

    Speed and turning rate are scaled alike, which preserves the curvature.

    Args:
        forward: Driving velocity, in [m/s].
        turn: Turning rate, in [rad/s].
        gait: Gait of the robot.
    """
    speed, rate = velocity_limits(gait)
    share = 1.0 / max(1.0, abs(forward) / speed, abs(turn) / rate)
    return share * forward, share * turn


def request_at_velocity(
    forward: float,
    turn: float,
    gait: GaitSettings,
    *,
    under_way: Direction | None,
) -> MotionRequest:
    """Return the request that walks at a velocity.

    Args:
        forward: Driving velocity, in [m/s].
        turn: Turning rate, in [rad/s].
        gait: Gait of the robot.
        under_way: Present direction of a walking robot; a reversal halts
            it first.
    """
    forward, turn = limit_velocity(forward, turn, gait)
    speed, rate = velocity_limits(gait)
    direction = Direction.FORWARD if forward >= 0.0 else Direction.BACKWARD
    if abs(forward) < STILL:
        direction = under_way or Direction.FORWARD
    rests = abs(forward) < STILL and abs(turn) < STILL
    if rests or under_way not in (None, direction):
        return MotionRequest(STAND, direction, saturated=False)
    share = max(IN_PLACE, min(1.0, abs(forward) / speed))
    return MotionRequest(
        Intent(pi * turn / rate, share), direction, saturated=False
    )
