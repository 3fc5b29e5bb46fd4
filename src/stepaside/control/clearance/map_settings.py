"""Settings of a robot's map of the room, and of its clearance."""

from dataclasses import dataclass
from typing import ClassVar

from ...core.errors import ConfigurationError
from ...core.ranges import Range, Ranges, check_settings

ERROR = ConfigurationError
MAPS = ("given", "seen", "none")
UNSEEN = ("free", "taken")


@dataclass(frozen=True, slots=True)
class MapSettings:
    """Map of the room that robots use.

    Attributes:
        source: "given" for the true room, "seen" for a map from the own depth
            camera, "none" for no map.
        margin: Clearance that a body keeps from known obstacles, in [m]; 0 to
            1.
        unseen: Whether unknown floor counts as "free" or "taken".
    """

    source: str = "given"
    margin: float = 0.02
    unseen: str = "taken"

    ranges: ClassVar[Ranges] = {
        "margin": Range(0.0, 1.0, "m", "a larger margin leaves no free floor")
    }

    def __post_init__(self) -> None:
        """Validate the settings."""
        for name, known in (("source", MAPS), ("unseen", UNSEEN)):
            value = getattr(self, name)
            if value not in known:
                raise ERROR(
                    f"map {name} must be one of {', '.join(known)}, "
                    f"got {value!r:.40}"
                )
        check_settings(self, prefix="map ")
