"""A person instead of the pursuing robot."""

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
    """How a person walks.

    Attributes:
        path: "steer" turns towards the evader by (1)-(2), "straight" walks
            on in the direction in which the walk begins, "visits" comes and
            goes, each time from elsewhere, and everything else is a file of a
            recorded path: CSV lines of time [s], x [m] and y [m] with a head
            line ``time,x,y``.
        speed: Of the walk, in [m/s]; 0.001 to 3.
        gain: Of the steering (1)-(2), in [1/s] of real time; 0.0001 to 100.
        miss: How far to the left of the evader a straight walk aims, and the
            first of many visits, [m]; -10 to 10.
        halt_after: Way after which the person stands still, in [m]; 0 to 100
            or inf.
        turn_after: Way after which the person turns once, in [m]; 0 to 100
            or inf.
        turn: By how much, in [rad], positive leftward; -3.14159 to 3.14159.
        backward: Whether the person walks backward, and so faces away from
            where the walk goes.
        figure: "adult" or "child", who differ in size, clothes and steps.
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
        "speed": Range(1e-3, 3.0, "m/s", "whoever is faster runs"),
        "gain": Range(1e-4, 100.0, "1/s", "as a robot's"),
        "miss": Range(-10.0, 10.0, "m", "farther by is out of sight"),
        "halt_after": Range(
            *(0.0, 100.0, "m"), "farther on it is another walk", also=(inf,)
        ),
        "turn_after": Range(
            *(0.0, 100.0, "m"), "farther on it is another walk", also=(inf,)
        ),
        "turn": Range(-pi, pi, "rad", "more is less to the other side"),
    }

    def __post_init__(self) -> None:
        """Refuse a walk that is none."""
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
    """Refuse an unknown pursuer.

    Raises:
        ConfigurationError: If it is none.
    """
    if pursuer not in PURSUERS:
        raise ConfigurationError(
            f"pursuer must be one of {', '.join(PURSUERS)}, got {pursuer!r}"
        )


__all__ = ["PURSUERS", "PersonSettings", "check_pursuer"]
