"""How a robot whose joints are moved is handled, whatever it speaks."""

from collections.abc import Callable
from dataclasses import dataclass, field

from ..cameras.image_source import ImageSource
from .safety_conditions import SafetySettings


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOptions:
    """What is asked of a session with a robot, beside where it is.

    Attributes:
        safety: Limits of what is safe.
        dry_run: Command nothing but lights.
        guarded: Whether a second process lets go of the robot if this one
            dies or freezes. Forks: not for a process with threads.
        open_eyes: Opens its cameras, if it is played with those instead of
            with an ideal line of sight. They may start threads. Raises
            SessionLost if there is no camera.
        patience: How long to wait for the robot to be there, in [s].
    """

    safety: SafetySettings = field(default_factory=SafetySettings)
    dry_run: bool = False
    guarded: bool = False
    open_eyes: Callable[[], ImageSource] | None = None
    patience: float = 0.0

    @property
    def guards(self) -> bool:
        """Whether there is something to guard, and somebody shall."""
        return self.guarded and not self.dry_run

    def eyes(self) -> ImageSource | None:
        """Open its cameras, if it is played with those."""
        return None if self.open_eyes is None else self.open_eyes()


PLAIN = SessionOptions()
