"""People who go their way while somebody comes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import atan2, cos, pi, sin
from typing import ClassVar

import mujoco

from ..errors import ConfigurationError
from ..poses import Pose
from ..ranges import Range, Ranges, check_settings
from .figures import FIGURES
from .person import add_person, parts_of, pose_figure

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


def add_passers(spec: mujoco.MjSpec, passers: Sequence[Passer]) -> None:
    """Put their figures into a world, to be moved.

    Args:
        spec: World.
        passers: Who they are.
    """
    for number, passer in enumerate(passers, start=1):
        add_person(spec, _name(number), FIGURES[passer.figure])


def passer_mover(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    passers: Sequence[Passer],
    evader: Pose,
) -> Callable[[float], None]:
    """What puts them where they are at a time, in [s].

    Args:
        model: World that has them.
        data: Its state.
        passers: Who they are.
        evader: Where the evader stands at first, in the world.
    """
    parts = [parts_of(model, _name(i + 1)) for i in range(len(passers))]

    def move(time: float) -> None:
        for own, passer in zip(parts, passers, strict=True):
            pose, way = passer.pose_at(time, evader), passer.speed * time
            pose_figure(data, own, pose, way, FIGURES[passer.figure])

    return move


def _name(number: int) -> str:
    """Prefix of the bodies of a passer; what touches one is told so."""
    return f"passer {number}"
