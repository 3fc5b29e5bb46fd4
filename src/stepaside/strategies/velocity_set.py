"""Body velocities that legs deliver, and how fast they respond."""

from math import cos, expm1, hypot, sin
from typing import Any, NamedTuple

from ..core.compilation import inlined

Bounds = tuple[float, float]
"""Least and greatest value; zero is between them."""


class BodyVelocity(NamedTuple):
    """Velocity of a body in its own frame, over the floor."""

    forward: float = 0.0  # ahead [m/s]
    lateral: float = 0.0  # to the left [m/s]
    turn: float = 0.0  # turning rate [rad/s], positive to the left


STILL = BodyVelocity()


class AxisValues(NamedTuple):
    """One value for each axis of a body velocity."""

    forward: float = 0.0
    lateral: float = 0.0
    turn: float = 0.0


class VelocitySet(NamedTuple):
    """Velocities that legs deliver, in the frame of the body.

    Horizontal velocities fill an ellipse whose half axes are the bounds
    ahead, behind and to the sides; the turning rate is bounded by itself.
    """

    forward: Bounds  # bounds ahead [m/s]
    lateral: Bounds  # bounds to the left [m/s]; (0, 0) for a unicycle
    turn: Bounds  # bounds of the turning rate [rad/s]
    lags: AxisValues = AxisValues()  # delay of the motion [s]
    # motion along each axis from the command to stand until the body stands,
    # at the greatest velocity [m, m, rad]
    halting: AxisValues = AxisValues()
    # greatest distance of the body from a point that follows commands at once,
    # see :class:`.shield.TemplatePoint` [m]; 0 if it is not known
    tube: float = 0.0

    @property
    def bounds(self) -> dict[str, Bounds]:
        """Bounds of each axis alone, by its name."""
        return dict(zip(BodyVelocity._fields, self[:3], strict=True))

    def nearest(self, velocity: BodyVelocity) -> BodyVelocity:
        """Return the velocity in the set with the path of another.

        What the legs do not deliver at all is left out; the rest is scaled
        alike, so that direction and curvature stay the same.
        """
        share, relative, kept = 1.0, [], []
        for value, (low, high) in zip(velocity, self[:3], strict=True):
            limit = high if value > 0.0 else -low
            kept.append(value if limit > 0.0 else 0.0)
            relative.append(abs(value) / limit if limit > 0.0 else 0.0)
            if relative[-1] > 1.0:
                share = min(share, limit / abs(value))
        oblique = hypot(*relative[:2])
        if relative[0] and relative[1] and oblique > 1.0:
            share = min(share, 1.0 / oblique)
        return BodyVelocity(*(share * value for value in kept))


@inlined
def response_share(duration: float, lag: float) -> float:
    """Return the share of a change that a duration brings with a lag [s]."""
    return -expm1(-duration / lag) if lag > 0.0 else 1.0


def respond(
    velocity: BodyVelocity,
    command: BodyVelocity,
    lags: AxisValues,
    duration: float,
) -> BodyVelocity:
    """Return the velocity of legs a duration [s] after a command."""
    axes = zip(velocity, command, lags, strict=True)
    return BodyVelocity(
        *(v + response_share(duration, lag) * (c - v) for v, c, lag in axes)
    )


@inlined
def greatest_velocity(angle: float, bounds: Any) -> tuple[float, float]:
    """Return the fastest velocity in a direction of the body, in [m/s].

    Components ahead and to the left, within a velocity set or its first two
    bounds; a unicycle walks at its component of the velocity.
    """
    c, s = cos(angle), sin(angle)
    ahead = bounds[0][1] if c > 0.0 else -bounds[0][0]
    left = bounds[1][1] if s > 0.0 else -bounds[1][0]
    if ahead > 0.0 and left > 0.0:
        speed = 1.0 / hypot(c / ahead, s / left)
        return speed * c, speed * s
    return c * max(ahead, 0.0), s * max(left, 0.0)
