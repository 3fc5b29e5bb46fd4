"""What a robot accepts: velocities within limits, reached by a ramp."""

from dataclasses import dataclass
from math import inf, isfinite

from ...core.errors import ConfigurationError, check_positive
from .velocity_body import REST, VelocityCommand


@dataclass(frozen=True, slots=True)
class VelocityLimits:
    """What a robot accepts.

    Attributes:
        forward: Greatest speed ahead, in [m/s].
        backward: Greatest speed backward, in [m/s].
        turn: Greatest turning rate, in [rad/s].
        acceleration: Greatest change of the speed, in [m/s^2].
        turn_acceleration: Greatest change of the rate, in [rad/s^2].
    """

    forward: float = inf
    backward: float = inf
    turn: float = inf
    acceleration: float = 0.5
    turn_acceleration: float = 2.0

    def __post_init__(self) -> None:
        """Refuse limits that let nothing through."""
        error = ConfigurationError
        for name in ("forward", "backward"):
            if not getattr(self, name) == inf:
                check_positive(getattr(self, name), name, "m/s", error)
        if self.turn != inf:
            check_positive(self.turn, "turn", "rad/s", error)
        check_positive(self.acceleration, "acceleration", "m/s^2", error)
        check_positive(
            self.turn_acceleration, "turn_acceleration", "rad/s^2", error
        )

    def within(self, wanted: VelocityCommand) -> VelocityCommand:
        """A velocity that the robot accepts.

        Who is too fast is slowed down on its path: speed and turning rate
        are scaled alike, so that the path keeps its curvature, and with it
        the circle its radius.

        Args:
            wanted: Finite.
        """
        speed, rate = abs(wanted.forward), abs(wanted.turn)
        top = self.forward if wanted.forward > 0.0 else self.backward
        share = min(
            1.0,
            top / speed if speed > 0.0 else 1.0,
            self.turn / rate if rate > 0.0 else 1.0,
        )
        return VelocityCommand(share * wanted.forward, share * wanted.turn)


class Ramp:
    """Changes what is asked for no faster than the limits say.

    Attributes:
        velocity: What is asked for now.
    """

    def __init__(self, limits: VelocityLimits) -> None:
        """Begin at rest."""
        self._limits = limits
        self.velocity = REST

    def toward(
        self, wanted: VelocityCommand, passed: float
    ) -> VelocityCommand:
        """Go toward a velocity.

        Args:
            wanted: Where to; what is no number is rest, at once.
            passed: Time since the last call, in [s].
        """
        if not (isfinite(wanted.forward) and isfinite(wanted.turn)):
            return self.stop()
        limits, now = self._limits, self.velocity
        goal = limits.within(wanted)
        self.velocity = VelocityCommand(
            _step(now.forward, goal.forward, limits.acceleration * passed),
            _step(now.turn, goal.turn, limits.turn_acceleration * passed),
        )
        return self.velocity

    def stop(self) -> VelocityCommand:
        """Rest at once: a robot that walks by itself ends its own step."""
        self.velocity = REST
        return REST


def _step(value: float, goal: float, most: float) -> float:
    return value + min(max(goal - value, -most), most)
