"""Settings of people who walk past the evader."""

from dataclasses import dataclass
from math import atan2, cos, pi, sin
from typing import ClassVar

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..core.ranges import Range, Ranges, check_settings
from .pedestrian_models import FIGURES

MOST_PASSERS = 20  # of one game
METRES = Range(-20.0, 20.0, "m", "beyond, out of sight")


@dataclass(frozen=True, slots=True)
class Passer:
    """Person who walks straight past the initial position of the evader.

    Attributes:
        speed: Walking speed, in [m/s]; 0 stands still; 0 to 3.
        distance: Initial distance from the evader, in [m]; 0 to 100.
        bearing: Initial bearing from the evader's heading, in [rad], positive
            leftward; -3.14159 to 3.14159.
        miss: Lateral offset of the walk from the evader, positive to the left
            of the walk, in [m]; -20 to 20.
        figure: "adult" or "child".
    """

    speed: float
    distance: float
    bearing: float = 0.0
    miss: float = 1.2
    figure: str = "adult"

    ranges: ClassVar[Ranges] = {
        "speed": Range(0.0, 3.0, "m/s", "faster is running"),
        "distance": Range(0.0, 100.0, "m", "the farthest start of a walk"),
        "bearing": Range(-pi, pi, "rad", "half a turn"),
        "miss": METRES,
    }

    def __post_init__(self) -> None:
        """Check the ranges and the figure."""
        check_settings(self, prefix="passer ")
        if self.figure not in FIGURES:
            raise ConfigurationError(
                f"passer figure must be one of {', '.join(FIGURES)}, got "
                f"{self.figure!r}"
            )

    def pose_at(self, time: float, evader: Pose) -> Pose:
        """Return the pose at a time, in the world.

        Args:
            time: Time since the start of the game, in [s].
            evader: Initial pose of the evader in the world.
        """
        distance = self.distance
        start = Pose(
            distance * cos(self.bearing), distance * sin(self.bearing), 0.0
        )
        ahead = self.bearing + pi
        aim = -self.miss * sin(ahead), self.miss * cos(ahead)
        course = atan2(aim[1] - start.y, aim[0] - start.x)
        walked = self.speed * time
        return evader.compose(
            Pose(
                start.x + walked * cos(course),
                start.y + walked * sin(course),
                course,
            )
        )
