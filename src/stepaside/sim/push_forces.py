"""Forces of pushes on a body of the world."""

from collections import deque
from math import atan2, cos, sin

import mujoco

from .push import Push, ScheduledPush

MAX_STORED = 1000  # pushes; a live game may run without end


class PushApplier:
    """Pushes of one body: total impulse [N s], and the latest pushes."""

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, torso: int
    ) -> None:
        self._force = data.xfrc_applied[torso]
        self._frame = data.xmat[torso]
        self._position = data.xpos[torso]
        self._time_step = model.opt.timestep
        self._scheduled: list[Push] = []
        self._active: list[tuple[float, float, float]] = []
        self.impulse = (0.0, 0.0)
        self.given: deque[ScheduledPush] = deque(maxlen=MAX_STORED)

    def add(self, push: Push) -> None:
        """Schedule a push."""
        self._scheduled = sorted(
            [*self._scheduled, push], key=lambda push: push.time
        )

    def before_step(self, time: float) -> None:
        """Set the force for the physics step that starts at a time, [s]."""
        if not self._scheduled and not self._active:
            return
        while self._scheduled and self._scheduled[0].time <= time + 1e-9:
            self._start(self._scheduled.pop(0), time)
        self._active = [a for a in self._active if a[0] > time + 1e-9]
        fx = sum(a[1] for a in self._active)
        fy = sum(a[2] for a in self._active)
        self._force[0], self._force[1] = fx, fy
        given, h = self.impulse, self._time_step
        self.impulse = given[0] + fx * h, given[1] + fy * h

    def _start(self, push: Push, time: float) -> None:
        """Start a push, in the direction of the torso's heading."""
        angle = atan2(self._frame[3], self._frame[0]) + push.direction
        force = push.impulse / push.duration
        fx, fy = force * cos(angle), force * sin(angle)
        self._active.append((time + push.duration, fx, fy))
        x, y, _ = self._position.tolist()
        whole = fx * push.duration, fy * push.duration
        self.given.append(ScheduledPush(time, push.duration, x, y, *whole))
