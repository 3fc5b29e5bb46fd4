"""Rest for a robot that walks on when nobody tells it to stop."""

from collections.abc import Callable

from ..guardian import Guardian
from .body import REST, Report, Velocity, VelocityBody

SILENCE = 0.5  # of control before the guardian acts, in [s]


def guardian_of(let_go: Callable[[], None]) -> Guardian:
    """Fork a guardian.

    Args:
        let_go: Makes the robot rest, over a line of its own. It is called
            in the other process.
    """
    return Guardian(lambda _: let_go(), SILENCE)


class GuardedBody:
    """A robot whose guardian hears what it is asked for."""

    def __init__(self, body: VelocityBody, guardian: Guardian) -> None:
        """Join both."""
        self._body, self._guardian = body, guardian

    def listen(self, patience: float) -> Report | None:
        """Newest report since the last."""
        return self._body.listen(patience)

    def command(self, velocity: Velocity) -> None:
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
