"""Settings of what robots know of a room, and how clear they keep."""

from dataclasses import dataclass
from typing import ClassVar

from ...core.errors import ConfigurationError
from ...core.ranges import Range, Ranges, check_settings

ERROR = ConfigurationError
MAPS = ("given", "seen", "none")
UNSEEN = ("free", "taken")


@dataclass(frozen=True, slots=True)
class MapSettings:
    """What robots know of the room around them.

    Attributes:
        source: "given" for the room as it is, "seen" for what their depth
            cameras have seen of it, "none" for nothing.
        margin: Distance that a body keeps from all that it knows of, in [m]; 0
            to 1.
        unseen: Whether floor that nobody has seen is "free" or "taken".
    """

    source: str = "given"
    margin: float = 0.02
    unseen: str = "taken"

    ranges: ClassVar[Ranges] = {
        "margin": Range(0.0, 1.0, "m", "with more, no room has a place")
    }

    def __post_init__(self) -> None:
        """Refuse other maps, and margins that no room allows."""
        for name, known in (("source", MAPS), ("unseen", UNSEEN)):
            value = getattr(self, name)
            if value not in known:
                raise ERROR(
                    f"map {name} must be one of {', '.join(known)}, "
                    f"got {value!r:.40}"
                )
        check_settings(self, prefix="map ")
