"""Somebody bumps into a robot."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import ClassVar, NamedTuple

from ..core.errors import ConfigurationError
from ..core.ranges import Range, Ranges, check_settings

MOST_PUSHES = 1000  # of one game


@dataclass(frozen=True, slots=True)
class Push:
    """A constant force at the torso for a short while.

    Attributes:
        impulse: Force times duration, in [N s]; 0 to 1000.
        time: When it begins, in [s]; 0 to 86400.
        direction: Where it pushes to, from the robot's heading at that time,
            in [rad]: 0 forward, pi/2 to the left; -6.28319 to 6.28319.
        duration: How long it lasts, in [s]; 0.0001 to 100.
        player: Who is pushed; by default the walker, or a duel's evader.
    """

    impulse: float
    time: float
    direction: float
    duration: float = 0.1
    player: str = ""

    ranges: ClassVar[Ranges] = {
        "impulse": Range(0.0, 1000.0, "N s", "a car does not give more"),
        "time": Range(0.0, 86400.0, "s", "as long as a walk may be"),
        "direction": Range(-2 * pi, 2 * pi, "rad", "a whole turn"),
        "duration": Range(1e-4, 100.0, "s", "some steps of the physics"),
    }

    def __post_init__(self) -> None:
        """Refuse pushes that nobody can give."""
        check_settings(self, prefix="push ")


class ScheduledPush(NamedTuple):
    """A push as it was given, in the world.

    Attributes:
        time: When it began, in [s].
        duration: How long it lasts, in [s].
        x: Place of the torso when it began, in [m].
        y: Likewise.
        impulse_x: Impulse, in [N s].
        impulse_y: Likewise.
    """

    time: float
    duration: float
    x: float
    y: float
    impulse_x: float
    impulse_y: float


def check_pushes(pushes: Sequence[Push], robots: Sequence[str]) -> None:
    """Refuse pushes of somebody who is no robot of a game.

    Args:
        pushes: Whoever bumps into whom.
        robots: Names of those who can be pushed; the last is meant by a push
            that names nobody.

    Raises:
        ConfigurationError: If a push names somebody else.
    """
    for push in pushes:
        if push.player not in ("", *robots):
            raise ConfigurationError(
                f"push player must be one of {', '.join(robots)}, who can be "
                f"pushed, got {push.player!r}"
            )


def pushes_of(
    pushes: Sequence[Push], robots: Sequence[str]
) -> dict[str, tuple[Push, ...]]:
    """Pushes by name of who is pushed; see :func:`check_pushes`."""
    named = [(push.player or robots[-1], push) for push in pushes]
    return {
        name: tuple(push for who, push in named if who == name)
        for name in robots
    }
