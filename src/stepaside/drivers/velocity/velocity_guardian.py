"""Guardian of a robot that keeps its last velocity command."""

import logging
from collections.abc import Callable
from contextlib import suppress

from ...core.errors import StepAsideError
from ..guardian_process import Guardian, SessionLost
from .velocity_body import REST, VelocityBody, VelocityCommand, VelocityReport

SILENCE = 0.5  # time without control before the guardian acts, in [s]
log = logging.getLogger(__name__)


def fork_velocity_guardian(
    join: Callable[[], Callable[[], None]], silence: float = SILENCE
) -> Guardian:
    """Fork a guardian, which connects to the robot at once.

    Connecting in advance, as it takes longer than stopping the robot.

    Args:
        join: Function that connects to the robot and returns a function
            that stops it. Called in the guardian process; called again, if
            it failed at first, when the robot is to be stopped.
        silence: Time without control before the guardian acts, in [s].
    """
    stops: list[Callable[[], None]] = []

    def prepare() -> None:
        with suppress(StepAsideError):
            stops.append(join())

    def stop(data: bytes) -> None:
        stop_robot = stops[0] if stops else join()
        stop_robot()

    return Guardian(stop, silence, prepare=prepare)


class GuardedBody:
    """Robot with a guardian that is informed of every command."""

    def __init__(self, body: VelocityBody, guardian: Guardian) -> None:
        """Combine a robot and its guardian."""
        self._body, self._guardian = body, guardian

    def listen(self, patience: float) -> VelocityReport | None:
        """Return the newest report since the last call, or None."""
        return self._body.listen(patience)

    def command(self, velocity: VelocityCommand) -> None:
        """Send a velocity command, and inform the guardian."""
        if velocity == REST:
            self._guardian.leave()
        else:
            self._guardian.hold()
        self._body.command(velocity)

    def close(self) -> None:
        """Stop the robot, by the guardian if need be, and dismiss it."""
        try:
            self._body.close()
        except SessionLost as error:
            log.warning("%s; the guardian stops the robot", error)
            self._guardian.release()
        self._guardian.dismiss()
