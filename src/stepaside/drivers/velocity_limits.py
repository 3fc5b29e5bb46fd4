"""Limits of velocity commands, and a ramp between commands."""

from dataclasses import dataclass, replace
from math import inf, isfinite

from ..core.errors import (
    ConfigurationError,
    check_positive,
    check_within,
)
from ..strategies.velocity_set import BodyVelocity, VelocitySet

REST = BodyVelocity(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class VelocityLimits:
    """Limits of a robot's velocity commands.

    Attributes:
        forward: Maximum forward speed, in [m/s].
        backward: Maximum backward speed, in [m/s].
        turn: Maximum turning rate, in [rad/s].
        acceleration: Maximum linear acceleration, in [m/s^2].
        turn_acceleration: Maximum angular acceleration, in [rad/s^2].
        lateral: Maximum lateral speed, in [m/s]; 0 for a robot that does not
            walk sideways.
    """

    forward: float = inf
    backward: float = inf
    turn: float = inf
    acceleration: float = 0.5
    turn_acceleration: float = 2.0
    lateral: float = 0.0

    def __post_init__(self) -> None:
        """Validate the limits."""
        error = ConfigurationError
        for name in ("forward", "backward"):
            if not getattr(self, name) == inf:
                check_positive(getattr(self, name), name, "m/s", error)
        if self.turn != inf:
            check_positive(self.turn, "turn", "rad/s", error)
        check_within(self.lateral, 0.0, 100.0, "lateral", "m/s", error)
        check_positive(self.acceleration, "acceleration", "m/s^2", error)
        check_positive(
            self.turn_acceleration, "turn_acceleration", "rad/s^2", error
        )

    def within(self, speed: float, turn: float) -> "VelocityLimits":
        """Return the limits where neither exceeds another one.

        Args:
            speed: Maximum speed in each direction, in [m/s].
            turn: Maximum turning rate, in [rad/s].
        """
        return replace(
            self,
            forward=min(self.forward, speed),
            backward=min(self.backward, speed),
            turn=min(self.turn, turn),
            lateral=min(self.lateral, speed),
        )

    @property
    def velocities(self) -> VelocitySet | None:
        """Velocities of a robot that walks sideways; None for a unicycle."""
        if self.lateral == 0.0:
            return None
        return VelocitySet(
            (-self.backward, self.forward),
            (-self.lateral, self.lateral),
            (-self.turn, self.turn),
        )

    def scale(self, wanted: BodyVelocity) -> BodyVelocity:
        """Scale a velocity into the limits.

        All components are scaled by the same factor, so that the path keeps
        its curvature, and with it the circle its radius. A robot that does
        not walk sideways is commanded no lateral velocity.
        """
        speed, rate = abs(wanted.forward), abs(wanted.turn)
        top = self.forward if wanted.forward > 0.0 else self.backward
        aside = abs(wanted.lateral) if self.lateral > 0.0 else 0.0
        factor = min(
            1.0,
            top / speed if speed > 0.0 else 1.0,
            self.lateral / aside if aside > 0.0 else 1.0,
            self.turn / rate if rate > 0.0 else 1.0,
        )
        return BodyVelocity(
            factor * wanted.forward,
            factor * wanted.lateral if aside > 0.0 else 0.0,
            factor * wanted.turn,
        )


class Ramp:
    """Rate limiter of velocity commands.

    Attributes:
        velocity: Newest command.
    """

    def __init__(self, limits: VelocityLimits) -> None:
        """Start at zero velocity."""
        self._limits = limits
        self.velocity = REST

    def toward(self, wanted: BodyVelocity, passed: float) -> BodyVelocity:
        """Move the command toward a velocity, and return it.

        Args:
            wanted: Target velocity; NaN or inf stops at once.
            passed: Time since the last call, in [s].
        """
        if not all(isfinite(value) for value in wanted):
            return self.stop()
        limits, now = self._limits, self.velocity
        goal = limits.scale(wanted)
        self.velocity = BodyVelocity(
            _step(now.forward, goal.forward, limits.acceleration * passed),
            _step(now.lateral, goal.lateral, limits.acceleration * passed),
            _step(now.turn, goal.turn, limits.turn_acceleration * passed),
        )
        return self.velocity

    def stop(self) -> BodyVelocity:
        """Command zero velocity at once: the robot finishes its own step."""
        self.velocity = REST
        return REST


def _step(value: float, goal: float, most: float) -> float:
    return value + min(max(goal - value, -most), most)
