"""Settings of people who walk past the evader."""

from dataclasses import dataclass
from math import atan2, cos, pi, sin

from ..core.poses import Pose
from ..core.ranges import Range
from ..core.setting import REQUIRED, check_settings, setting
from .pedestrian_appearance import FIGURES

MOST_PASSERS = 20  # of one game
METRES = Range(-20.0, 20.0, "m", "beyond, out of sight")


@dataclass(frozen=True, slots=True)
class Passer:
    """Person who walks straight past the initial position of the evader."""

    speed: float = setting(
        REQUIRED,
        "Walking speed {unit}; 0 stands still",
        Range(0.0, 3.0, "m/s", "faster is running"),
    )
    distance: float = setting(
        REQUIRED,
        "Initial distance from the evader",
        Range(0.0, 100.0, "m", "the farthest start of a walk"),
    )
    bearing: float = setting(
        0.0,
        "Initial bearing from the evader's heading {unit}, positive leftward",
        Range(-pi, pi, "rad", "half a turn"),
    )
    miss: float = setting(
        1.2,
        "Lateral offset of the walk from the evader, positive to the left of "
        "the walk",
        METRES,
    )
    figure: str = setting("adult", "Body model", names=FIGURES)

    def __post_init__(self) -> None:
        """Check the ranges and the figure."""
        check_settings(self, prefix="passer ")

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
