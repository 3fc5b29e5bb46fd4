"""Walking at a velocity: what a gait does for a robot that is driven so."""

from math import pi

from ..planning import Direction, GaitSettings
from ..strategies import StandStill, Strategy, Walk

STILL = 1e-3  # speed [m/s] or turning rate [rad/s] that is rest
IN_PLACE = 1e-3  # share of a stride of who turns where it stands


def fastest(gait: GaitSettings) -> tuple[float, float]:
    """Greatest speed [m/s] and turning rate [rad/s] of a gait.

    A stride takes a whole step, which is longer than the time that the
    template takes for it; and nobody turns to what is behind him.
    """
    pace = gait.path_interval / gait.step_duration
    return gait.speed * pace, gait.gain * pace * pi


def accepted(
    forward: float, turn: float, gait: GaitSettings
) -> tuple[float, float]:
    """Velocity that a gait can walk, on the path that was asked for.

    Speed and turning rate are cut alike, so that the curvature stays.

    Args:
        forward: Driving velocity, in [m/s].
        turn: Turning rate, in [rad/s].
        gait: How the robot walks.
    """
    speed, rate = fastest(gait)
    share = 1.0 / max(1.0, abs(forward) / speed, abs(turn) / rate)
    return share * forward, share * turn


def walk_at(
    forward: float,
    turn: float,
    gait: GaitSettings,
    *,
    under_way: Direction | None,
) -> Strategy:
    """Strategy of a robot that is driven: strides and turns of its gait.

    Args:
        forward: Driving velocity, in [m/s].
        turn: Turning rate, in [rad/s].
        gait: How the robot walks.
        under_way: Where it walks already, if it does: who is to go the
            other way comes to rest first.
    """
    forward, turn = accepted(forward, turn, gait)
    speed, rate = fastest(gait)
    if abs(forward) < STILL and abs(turn) < STILL:
        return StandStill()
    direction = Direction.FORWARD if forward >= 0.0 else Direction.BACKWARD
    if abs(forward) < STILL:
        direction = under_way or Direction.FORWARD
    if under_way is not None and direction is not under_way:
        return StandStill()
    share = max(IN_PLACE, min(1.0, abs(forward) / speed))
    return Walk(pi * turn / rate, direction, False, share)
