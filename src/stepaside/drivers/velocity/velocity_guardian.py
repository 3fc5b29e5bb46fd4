"""Rest for a robot that walks on when nobody tells it to stop."""

from collections.abc import Callable
from contextlib import suppress

from ...core.errors import StepAsideError
from ..guardian_process import Guardian
from .velocity_body import REST, VelocityBody, VelocityCommand, VelocityReport

SILENCE = 0.5  # of control before the guardian acts, in [s]


def guardian_of(join: Callable[[], Callable[[], None]]) -> Guardian:
    """Fork a guardian, which joins the robot's line at once.

    Loading a language and finding the robot takes longer than stopping it.

    Args:
        join: Takes part in a line of its own, and returns what makes the
            robot rest. It is called in the other process; where it fails,
            once more when the robot is to rest.
    """
    joined: list[Callable[[], None]] = []

    def prepare() -> None:
        with suppress(StepAsideError):
            joined.append(join())

    def rest(word: bytes) -> None:
        let_go = joined[0] if joined else join()
        let_go()

    return Guardian(rest, SILENCE, prepare=prepare)


class GuardedBody:
    """A robot whose guardian hears what it is asked for."""

    def __init__(self, body: VelocityBody, guardian: Guardian) -> None:
        """Join both."""
        self._body, self._guardian = body, guardian

    def listen(self, patience: float) -> VelocityReport | None:
        """Newest report since the last."""
        return self._body.listen(patience)

    def command(self, velocity: VelocityCommand) -> None:
        """Ask for a velocity, and say so."""
        if velocity == REST:
            self._guardian.leave()
        else:
            self._guardian.hold()
        self._body.command(velocity)

    def close(self) -> None:
        """Let the robot rest, and the guardian go."""
        self._body.close()
        self._guardian.dismiss()
