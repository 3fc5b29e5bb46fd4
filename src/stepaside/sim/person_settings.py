"""Settings of people."""

from dataclasses import dataclass
from math import inf, pi

from ..core.errors import ConfigurationError
from ..core.ranges import Range
from ..core.setting import CheckedSettings, check_settings, setting

PATHS = ("steer", "straight")
REACTIONS = (
    *("none", "avoid-people", "regular", "impassive"),
    *("surprised", "curious", "scared", "threatening"),
)
RADIUS = 0.25  # of a person, in [m]


@dataclass(frozen=True, slots=True)
class CrowdSettings(CheckedSettings, prefix="crowd."):
    """Walk of a person to a goal."""

    speed: float = setting(
        0.8,
        "Desired speed of the person",
        Range(0.0, 3.0, "m/s", "faster is running"),
    )
    reaction: str = setting(
        "regular",
        "Reaction to others: none, to people but not robots, or to both. "
        "Robots are people for a regular person and obstacles for an "
        "impassive one. A surprised person halts, a curious one comes nearer, "
        "a scared one keeps away, and a threatening one blocks the robot",
        names=REACTIONS,
    )
    returns: bool = setting(
        False, "Walk back to the start, and again, instead of halting"
    )


@dataclass(frozen=True, slots=True)
class PersonSettings:
    """Walk of a person without a goal."""

    path: str = setting(
        "steer",
        "Path of the person: steer (towards the evader by eqs. (1)-(2)), "
        "straight, or a CSV file with columns time,x,y [s, m, m]",
    )
    speed: float = setting(
        0.15,
        "Walking speed of the person",
        Range(1e-3, 3.0, "m/s", "faster is running"),
    )
    gain: float = setting(
        0.2,
        "Steering gain of the person",
        Range(1e-4, 100.0, "1/s", "as of a robot"),
    )
    miss: float = setting(
        0.0,
        "Lateral offset to the left of the evader at which a straight path "
        "aims",
        Range(-10.0, 10.0, "m", "beyond, out of sight"),
    )
    turning_radius: float = setting(
        0.0,
        "Smallest turning radius of a person who steers",
        Range(0.0, 100.0, "m", "beyond, hardly a turn; 0 for no limit"),
    )
    feint_at: float = setting(
        0.0,
        "Distance to the evader at which a person who steers feints: turns "
        "to one side for a while, each time it comes that close",
        Range(0.0, 100.0, "m", "beyond, they never meet; 0 for never"),
    )
    feint: float = setting(
        0.6,
        "Duration of a feint {unit}, positive leftward",
        Range(-10.0, 10.0, "s", "beyond, the person walks away"),
    )
    halt_after: float = setting(
        inf,
        "Path length after which the person halts",
        Range(0.0, 100.0, "m", "the longest walk", also=(inf,)),
    )
    turn_after: float = setting(
        inf,
        "Path length after which the person turns once",
        Range(0.0, 100.0, "m", "the longest walk", also=(inf,)),
    )
    turn: float = setting(
        0.5 * pi,
        "Angle of that turn {unit}, positive leftward",
        Range(-pi, pi, "rad", "half a turn"),
    )
    backward: bool = setting(
        False,
        "Let the person walk backward",
    )
    solid: bool = setting(
        True,
        "Let the body of the person touch robots and obstacles in physics; "
        "otherwise they pass through it",
    )
    reaction: str = setting(
        "none",
        "Reaction to the robot of a person on a straight path, by the social "
        "force model; see docs/people.md",
        names=tuple(name for name in REACTIONS if name != "avoid-people"),
    )

    def __post_init__(self) -> None:
        check_settings(self, prefix="person.")
        if not self.path:
            raise ConfigurationError(
                f"person.path must be {', '.join(PATHS)} or a file, got ''"
            )
        plain = self.path == "straight" and not self.backward
        if self.reaction != "none" and not (
            plain and self.halt_after == self.turn_after == inf
        ):
            raise ConfigurationError(
                "person.reaction needs a straight path without halting, "
                f"turning or walking backward, got {self.reaction!r}"
            )
