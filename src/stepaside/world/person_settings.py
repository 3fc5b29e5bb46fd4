"""A person instead of the pursuing robot."""

from dataclasses import dataclass

from ..errors import ConfigurationError, check_positive, check_within

ERROR = ConfigurationError
PURSUERS = ("robot", "person")


@dataclass(frozen=True, slots=True)
class PersonSettings:
    """How a person walks.

    Attributes:
        path: "steer" turns towards the evader by (1)-(2), "straight" walks
            on in the direction in which the walk begins, and everything else
            is a file of a recorded path: CSV lines of time [s], x [m] and
            y [m] with a head line ``time,x,y``.
        speed: Of the walk, in [m/s].
        gain: Of the steering (1)-(2), in [1/s] of real time.
        miss: How far to the left of the evader a straight walk aims, [m].
    """

    path: str = "steer"
    speed: float = 0.15
    gain: float = 0.2
    miss: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a walk that is none."""
        check_within(self.speed, 0.0, 3.0, "person.speed", "m/s", ERROR)
        check_positive(self.speed, "person.speed", "m/s", ERROR)
        check_positive(self.gain, "person.gain", "1/s", ERROR)
        check_within(self.miss, -10.0, 10.0, "person.miss", "m", ERROR)
        if not self.path:
            raise ConfigurationError(
                "person.path must be steer, straight or a file, got ''"
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
