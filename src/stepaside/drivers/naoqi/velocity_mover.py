"""Velocity commands to ALMotion."""

from collections.abc import Callable
from typing import Any

from ..guardian_process import SessionLost
from ..velocity.velocity_body import REST, VelocityCommand
from .qi_session import answer_of

REPEAT = 0.25  # after which an unchanged velocity is sent again, in [s]
TIMEOUT = 1.0  # for the answer to a command, in [s]


class PendingCall:
    """Newest call to the robot, whose answer may be pending.

    Attributes:
        called: Time of the call, in [s].
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        """Start without a call."""
        self._clock = clock
        self._future: Any = None
        self._what = ""
        self.called = clock()

    @property
    def begun(self) -> bool:
        """Whether there has been a call."""
        return self._future is not None

    def send(self, what: str, future: Any) -> None:
        """Store a call that has just been made."""
        self._what, self._future = what, future
        self.called = self._clock()

    @property
    def arrived(self) -> bool:
        """Whether the call has been answered.

        Raises:
            SessionLost: If it was refused, or the answer is overdue.
        """
        if self._future is None:
            return True
        if self._future.isFinished():
            answer_of(self._future, self._what, within=0.0)
            return True
        if self._clock() - self.called > TIMEOUT:
            raise SessionLost(
                f"the robot did not answer {self._what} within {TIMEOUT:g} s"
            )
        return False


class VelocityMover:
    """Sender of velocities by ``move`` and ``stopMove``; it never waits."""

    def __init__(self, motion: Any, clock: Callable[[], float]) -> None:
        """Command an ALMotion, by the clock of this computer in [s]."""
        self._motion, self._clock = motion, clock
        self._call = PendingCall(clock)
        self._commanded = REST

    def command(self, velocity: VelocityCommand) -> None:
        """Command a velocity.

        Raises:
            SessionLost: If the robot cannot be reached or does not answer.
        """
        call = self._call
        if not call.arrived:
            return
        passed = self._clock() - call.called
        is_same = velocity == self._commanded and passed < REPEAT
        is_stopped = velocity == REST and self._commanded == REST
        if is_same or (is_stopped and call.begun):
            return
        self._commanded = velocity
        if velocity == REST:
            call.send("stopMove", self._motion.stopMove(_async=True))
        else:
            forward, turn, _ = velocity
            future = self._motion.move(forward, 0.0, turn, _async=True)
            call.send("move", future)
