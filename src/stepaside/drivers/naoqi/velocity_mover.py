"""How a robot on NAOqi that walks by itself is told to: by velocity."""

from collections.abc import Callable
from typing import Any, Protocol

from ..guardian_process import SessionLost
from ..velocity.velocity_body import REST, VelocityCommand
from .qi_session import answer_of, reason_of

REPEATED = 0.25  # after which the same velocity is asked for again, in [s]
STUCK = 1.0  # for which a command may be on its way, in [s]


class Mover(Protocol):
    """Takes what the template wants to ALMotion, without waiting for it."""

    def command(self, velocity: VelocityCommand) -> None:
        """Ask for a velocity.

        Raises:
            SessionLost: If the robot is gone or stuck.
        """


class PendingCall:
    """One call that is on its way to the robot, or none.

    Attributes:
        called: When the last one was made, in [s].
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        """Begin with none."""
        self._clock = clock
        self._future: Any = None
        self._what = ""
        self.called = clock()

    @property
    def begun(self) -> bool:
        """Whether there has been one."""
        return self._future is not None

    def send(self, what: str, future: Any) -> None:
        """Note a call that was made."""
        self._what, self._future = what, future
        self.called = self._clock()

    def refusal(self) -> str:
        """Why the last call was refused; empty if it was not, or is new."""
        future = self._future
        if future is None or not future.isFinished() or not future.hasError():
            return ""
        self._future = None
        return reason_of(future.error())

    @property
    def arrived(self) -> bool:
        """Whether the last call has been taken.

        Raises:
            SessionLost: If it was refused, or is on its way for too long.
        """
        if self._future is None:
            return True
        if self._future.isFinished():
            answer_of(self._future, self._what, within=0.0)
            return True
        if self._clock() - self.called > STUCK:
            raise SessionLost("the robot takes no command")
        return False


class VelocityMover:
    """Moves a robot by ``move``, until it is told otherwise."""

    def __init__(self, motion: Any, clock: Callable[[], float]) -> None:
        """Know its ALMotion, and the time of this computer."""
        self._motion, self._clock = motion, clock
        self._errand = PendingCall(clock)
        self._asked = REST

    def command(self, velocity: VelocityCommand) -> None:
        """Ask for a velocity.

        Raises:
            SessionLost: If the robot is gone or stuck.
        """
        errand = self._errand
        if not errand.arrived:
            return
        passed = self._clock() - errand.called
        same = velocity == self._asked and passed < REPEATED
        at_rest = velocity == REST and self._asked == REST
        if same or (at_rest and errand.begun):
            return
        self._asked = velocity
        if velocity == REST:
            errand.send("stopMove", self._motion.stopMove(_async=True))
        else:
            forward, turn = velocity
            call = self._motion.move(forward, 0.0, turn, _async=True)
            errand.send("move", call)
