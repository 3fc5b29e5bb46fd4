"""Somebody bumps into a robot."""

from dataclasses import dataclass
from math import cos, pi, sin

import mujoco

from ..errors import (
    ConfigurationError,
    check_not_negative,
    check_positive,
    check_within,
)

ERROR = ConfigurationError


@dataclass(frozen=True, slots=True)
class Push:
    """A constant force at the torso for a short while.

    Attributes:
        impulse: Force times duration, in [N s].
        time: When it begins, in [s].
        direction: Where it pushes to, from the robot's heading at that
            time, in [rad]: 0 forward, pi/2 to the left.
        duration: How long it lasts, in [s].
    """

    impulse: float
    time: float
    direction: float
    duration: float = 0.1

    def __post_init__(self) -> None:
        """Refuse pushes that nobody can give."""
        check_not_negative(self.impulse, "push impulse", "N s", ERROR)
        check_within(self.time, 0.0, 86400.0, "push time", "s", ERROR)
        check_within(
            self.direction, -2 * pi, 2 * pi, "push direction", "rad", ERROR
        )
        check_positive(self.duration, "push duration", "s", ERROR)


class Pusher:
    """Applies pushes to one body of a world.

    Attributes:
        impulse: Impulse given so far in the world, in [N s].
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        torso: int,
    ) -> None:
        """Prepare pushes of the body with a given number."""
        self._force = data.xfrc_applied[torso]
        self._frame = data.xmat[torso]
        self._time_step = model.opt.timestep
        self._waiting: list[Push] = []
        self._active: list[tuple[float, float, float]] = []
        self.impulse = (0.0, 0.0)

    def add(self, push: Push) -> None:
        """Take one more push."""
        self._waiting = sorted(
            [*self._waiting, push], key=lambda push: push.time
        )

    def before_step(self, time: float) -> None:
        """Set the force for the physics step that begins at a time, [s]."""
        if not self._waiting and not self._active:
            return
        while self._waiting and self._waiting[0].time <= time + 1e-9:
            push = self._waiting.pop(0)
            x, y = self._frame[0], self._frame[3]
            length = (x * x + y * y) ** 0.5 or 1.0
            x, y = x / length, y / length
            c, s = cos(push.direction), sin(push.direction)
            force = push.impulse / push.duration
            self._active.append(
                (
                    time + push.duration,
                    force * (c * x - s * y),
                    force * (c * y + s * x),
                )
            )
        self._active = [a for a in self._active if a[0] > time + 1e-9]
        fx = sum(a[1] for a in self._active)
        fy = sum(a[2] for a in self._active)
        self._force[0], self._force[1] = fx, fy
        given, h = self.impulse, self._time_step
        self.impulse = given[0] + fx * h, given[1] + fy * h
