"""Settings of a robot's map of the room, and of its clearance."""

from dataclasses import dataclass

from ...core.ranges import Range
from ...core.setting import check_settings, setting

MAPS = ("given", "seen", "none")
UNSEEN = ("free", "taken")


@dataclass(frozen=True, slots=True)
class MapSettings:
    """Map of the room that robots use."""

    source: str = setting(
        "given",
        "Map of the room that each robot has: the true map with its true "
        "pose (given), a map built from its depth camera and odometry (seen, "
        "which implies camera sensing), or none",
        names=MAPS,
    )
    margin: float = setting(
        0.02,
        "Clearance that a body keeps from known obstacles",
        Range(0.0, 1.0, "m", "a larger margin leaves no free floor"),
    )
    unseen: str = setting(
        "taken",
        "State of map cells that have not been observed",
        names=UNSEEN,
        needs=("map.source", "seen"),
    )

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self, prefix="map.")
