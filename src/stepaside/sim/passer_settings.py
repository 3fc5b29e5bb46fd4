"""Somebody who goes another way while a person comes."""

from dataclasses import dataclass
from math import atan2, cos, pi, sin
from typing import ClassVar

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..core.ranges import Range, Ranges, check_settings
from .pedestrian_models import FIGURES

MOST_PASSERS = 20  # of one game
METRES = Range(-20.0, 20.0, "m", "farther by is out of sight")


@dataclass(frozen=True, slots=True)
class Passer:
    """Somebody who walks straight on, past where the evader stands at first.

    Attributes:
        speed: Of the walk, in [m/s]; 0 stands; 0 to 3.
        distance: From the evader at first, in [m]; 0 to 100.
        bearing: Where from, seen from the evader's heading at first, in
            [rad], positive to its left; -3.14159 to 3.14159.
        miss: How far beside the evader the walk aims, to the left as it
            comes, in [m]; -20 to 20.
        figure: "adult" or "child".
    """

    speed: float
    distance: float
    bearing: float = 0.0
    miss: float = 1.2
    figure: str = "adult"

    ranges: ClassVar[Ranges] = {
        "speed": Range(0.0, 3.0, "m/s", "whoever is faster runs"),
        "distance": Range(0.0, 100.0, "m", "as far as anybody comes from"),
        "bearing": Range(-pi, pi, "rad", "half a turn"),
        "miss": METRES,
    }

    def __post_init__(self) -> None:
        """Refuse a walk that is none."""
        check_settings(self, prefix="passer ")
        if self.figure not in FIGURES:
            raise ConfigurationError(
                f"passer figure must be one of {', '.join(FIGURES)}, got "
                f"{self.figure!r}"
            )

    def pose_at(self, time: float, evader: Pose) -> Pose:
        """Where this one is, and heads.

        Args:
            time: Since the game began, in [s].
            evader: Where the evader stood then, in the world.
        """
        away = self.distance
        start = Pose(away * cos(self.bearing), away * sin(self.bearing), 0.0)
        ahead = self.bearing + pi
        aim = -self.miss * sin(ahead), self.miss * cos(ahead)
        course = atan2(aim[1] - start.y, aim[0] - start.x)
        way = self.speed * time
        return evader.compose(
            Pose(
                start.x + way * cos(course),
                start.y + way * sin(course),
                course,
            )
        )
