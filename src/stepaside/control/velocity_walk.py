"""Strategy that follows a velocity command within the limits of a gait."""

from math import pi

from ..planning import Direction, GaitSettings
from ..strategies import StandStill, Strategy, Walk

STILL = 1e-3  # speed [m/s] or turning rate [rad/s] that counts as zero
IN_PLACE = 1e-3  # speed factor of a turn on the spot


def velocity_limits(gait: GaitSettings) -> tuple[float, float]:
    """Return the greatest speed [m/s] and turning rate [rad/s] of a gait.

    A stride takes a whole step, which is longer than the time that the
    template takes for it. The largest desired heading is pi.
    """
    pace = gait.path_interval / gait.step_duration
    return gait.speed * pace, gait.gain * pace * pi


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


def strategy_at_velocity(
    forward: float,
    turn: float,
    gait: GaitSettings,
    *,
    under_way: Direction | None,
) -> Strategy:
    """Return the strategy that walks at a velocity.

    Args:
        forward: Driving velocity, in [m/s].
        turn: Turning rate, in [rad/s].
        gait: Gait of the robot.
        under_way: Present direction of a walking robot; a reversal halts
            it first.
    """
    forward, turn = limit_velocity(forward, turn, gait)
    speed, rate = velocity_limits(gait)
    if abs(forward) < STILL and abs(turn) < STILL:
        return StandStill()
    direction = Direction.FORWARD if forward >= 0.0 else Direction.BACKWARD
    if abs(forward) < STILL:
        direction = under_way or Direction.FORWARD
    if under_way is not None and direction is not under_way:
        return StandStill()
    share = max(IN_PLACE, min(1.0, abs(forward) / speed))
    return Walk(pi * turn / rate, direction, False, share)
