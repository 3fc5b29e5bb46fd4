"""Settings of a person who plays the pursuer."""

from dataclasses import dataclass
from math import inf, pi
from typing import ClassVar

from ..core.errors import ConfigurationError
from ..core.ranges import Range, Ranges, check_settings
from .pedestrian_models import FIGURES

PATHS = ("steer", "straight", "visits")
PURSUERS = ("robot", "person")


@dataclass(frozen=True, slots=True)
class PersonSettings:
    """Settings of the walk of a person.

    Attributes:
        path: "steer" steers towards the evader by (1)-(2), "straight" keeps
            the initial direction, "visits" crosses the room repeatedly from
            changing directions; any other text is the file of a recorded
            path: CSV lines of time [s], x [m] and y [m] with the header
            ``time,x,y``.
        speed: Walking speed, in [m/s]; 0.001 to 3.
        gain: Steering gain of (1)-(2), in [1/s]; 0.0001 to 100.
        miss: Lateral offset to the left of the evader at which a straight
            walk or the first visit aims, in [m]; -10 to 10.
        halt_after: Distance after which the person stands still, in [m]; 0 to
            100 or inf.
        turn_after: Distance after which the person turns once, in [m]; 0 to
            100 or inf.
        turn: Angle of that turn, in [rad], positive leftward; -3.14159 to
            3.14159.
        backward: Whether the person walks backward.
        figure: "adult" or "child", with different size, clothes and steps.
    """

    path: str = "steer"
    speed: float = 0.15
    gain: float = 0.2
    miss: float = 0.0
    halt_after: float = inf
    turn_after: float = inf
    turn: float = 0.5 * pi
    backward: bool = False
    figure: str = "adult"

    ranges: ClassVar[Ranges] = {
        "speed": Range(1e-3, 3.0, "m/s", "faster is running"),
        "gain": Range(1e-4, 100.0, "1/s", "as of a robot"),
        "miss": Range(-10.0, 10.0, "m", "beyond, out of sight"),
        "halt_after": Range(0.0, 100.0, "m", "the longest walk", also=(inf,)),
        "turn_after": Range(0.0, 100.0, "m", "the longest walk", also=(inf,)),
        "turn": Range(-pi, pi, "rad", "half a turn"),
    }

    def __post_init__(self) -> None:
        """Check the ranges, the path and the figure."""
        check_settings(self, prefix="person.")
        if not self.path:
            raise ConfigurationError(
                f"person.path must be {', '.join(PATHS)} or a file, got ''"
            )
        if self.figure not in FIGURES:
            raise ConfigurationError(
                f"person.figure must be one of {', '.join(FIGURES)}, got "
                f"{self.figure!r}"
            )


def check_pursuer(pursuer: str) -> None:
    """Check the kind of pursuer.

    Raises:
        ConfigurationError: If it is unknown.
    """
    if pursuer not in PURSUERS:
        raise ConfigurationError(
            f"pursuer must be one of {', '.join(PURSUERS)}, got {pursuer!r}"
        )


__all__ = ["PURSUERS", "PersonSettings", "check_pursuer"]
