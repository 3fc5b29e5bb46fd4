"""Options of a session with a robot that is driven by its joints."""

from collections.abc import Callable
from dataclasses import dataclass, field

from ..cameras.image_source import ImageSource
from .safety_conditions import SafetySettings


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOptions:
    """Options of a session.

    Attributes:
        safety: Limits of safe operation.
        dry_run: Whether to command nothing but lights.
        guarded: Whether a second process releases the robot if this one
            dies or freezes. Forks, so this process must have no threads.
        open_eyes: Function that opens the cameras, which replace the ideal
            line of sight. May start threads. Raises SessionLost if there is
            no camera.
        patience: Timeout of the connection, in [s].
    """

    safety: SafetySettings = field(default_factory=SafetySettings)
    dry_run: bool = False
    guarded: bool = False
    open_eyes: Callable[[], ImageSource] | None = None
    patience: float = 0.0

    @property
    def guards(self) -> bool:
        """Whether a guardian is needed: not if nothing is commanded."""
        return self.guarded and not self.dry_run

    def eyes(self) -> ImageSource | None:
        """Open the cameras, if they are used."""
        return None if self.open_eyes is None else self.open_eyes()


PLAIN = SessionOptions()
