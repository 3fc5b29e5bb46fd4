"""What lets pushes act on a body of the world."""

from collections import deque
from math import cos, sin

import mujoco

from .push import Push, ScheduledPush

KEPT = 1000  # pushes that are remembered; a live game has no end


class PushApplier:
    """Applies pushes to one body of a world.

    Attributes:
        impulse: Impulse given so far in the world, in [N s].
        given: The last pushes that began.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        torso: int,
    ) -> None:
        """Prepare pushes of the body with a given number."""
        self._force = data.xfrc_applied[torso]
        self._frame, self._place = data.xmat[torso], data.xpos[torso]
        self._time_step = model.opt.timestep
        self._waiting: list[Push] = []
        self._active: list[tuple[float, float, float]] = []
        self.impulse = (0.0, 0.0)
        self.given: deque[ScheduledPush] = deque(maxlen=KEPT)

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
            self._begin(self._waiting.pop(0), time)
        self._active = [a for a in self._active if a[0] > time + 1e-9]
        fx = sum(a[1] for a in self._active)
        fy = sum(a[2] for a in self._active)
        self._force[0], self._force[1] = fx, fy
        given, h = self.impulse, self._time_step
        self.impulse = given[0] + fx * h, given[1] + fy * h

    def _begin(self, push: Push, time: float) -> None:
        """Turn a push with the torso, and let it act from now on."""
        x, y = self._frame[0], self._frame[3]
        length = (x * x + y * y) ** 0.5 or 1.0
        x, y = x / length, y / length
        c, s = cos(push.direction), sin(push.direction)
        force = push.impulse / push.duration
        fx, fy = force * (c * x - s * y), force * (c * y + s * x)
        self._active.append((time + push.duration, fx, fy))
        at, lasts = self._place.tolist(), push.duration
        self.given.append(
            ScheduledPush(time, lasts, at[0], at[1], fx * lasts, fy * lasts)
        )
