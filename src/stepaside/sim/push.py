"""Pushes of robots."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Any, NamedTuple

from ..core.errors import ConfigurationError, shown
from ..core.ranges import Range
from ..core.setting import REQUIRED, check_settings, setting

MOST_PUSHES = 1000  # in one game


@dataclass(frozen=True, slots=True)
class Push:
    """Constant horizontal force at the torso for a short time."""

    impulse: float = setting(
        REQUIRED,
        "Impulse: force times duration",
        Range(0.0, 1000.0, "N s", "far beyond what a humanoid survives"),
    )
    time: float = setting(
        REQUIRED,
        "Time at which it begins",
        Range(0.0, 86400.0, "s", "the longest walk"),
    )
    direction: float = setting(
        REQUIRED,
        "Direction of the force relative to the robot's heading at that time "
        "{unit}: 0 forward, pi/2 to the left",
        Range(-2 * pi, 2 * pi, "rad", "a full turn"),
    )
    duration: float = setting(
        0.1, "Duration", Range(1e-4, 100.0, "s", "at least a physics step")
    )
    player: str = setting(
        "",
        "Name of the pushed robot; by default the walker, or the evader of a "
        "duel",
    )

    def __post_init__(self) -> None:
        check_settings(self, prefix="push ")

    @classmethod
    def from_text(cls, text: str) -> "Push":
        """Return the push of a text: 1.2@5:90deg is 1.2 N s at 5 s, left.

        The player may precede it, as in ``pursuer=1.2@5:90deg``.
        """
        parts = _SYNTAX.fullmatch(text)
        if parts is None:
            raise ConfigurationError(
                "a push must be [PLAYER=]IMPULSE@TIME:DIRECTION [N s, s, "
                f"angle] like 1.2@5:90deg, got {shown(text)}"
            )
        return cls(
            _number(parts["impulse"]),
            _number(parts["time"]),
            _number(parts["direction"]),
            player=parts["player"] or "",
        )


_SYNTAX = re.compile(
    r"(?:(?P<player>[a-z]+)=)?(?P<impulse>[^@=]+)@(?P<time>[^:]+):"
    r"(?P<direction>.+)"
)


def _number(text: str) -> Any:
    """Return a number; any other text as it is, for the checks of fields."""
    try:
        return float(text)
    except ValueError:
        return text


class ScheduledPush(NamedTuple):
    """Push with its impulse in the world."""

    time: float  # start time [s]
    duration: float  # [s]
    x: float  # position of the torso at the start, x in the world [m]
    y: float  # position of the torso at the start, y in the world [m]
    impulse_x: float  # impulse along x of the world [N s]
    impulse_y: float  # impulse along y of the world [N s]


def check_pushes(pushes: Sequence[Push], robots: Sequence[str]) -> None:
    """Check that pushes name robots of a game, or none."""
    for push in pushes:
        if push.player not in ("", *robots):
            raise ConfigurationError(
                f"push player must be one of {', '.join(robots)}, got "
                f"{push.player!r}"
            )


def pushes_by_robot(
    pushes: Sequence[Push], robots: Sequence[str]
) -> dict[str, tuple[Push, ...]]:
    """Group pushes by the name of the robot; see :func:`check_pushes`."""
    return {
        name: tuple(p for p in pushes if (p.player or robots[-1]) == name)
        for name in robots
    }
