"""Settings of a person who plays the pursuer."""

from dataclasses import dataclass
from math import inf, pi

from ..core.errors import ConfigurationError
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from .crowd_motion import REACTIONS

PATHS = ("steer", "straight")
PURSUERS = ("robot", "person")


@dataclass(frozen=True, slots=True)
class PersonSettings:
    """Settings of the walk of a person."""

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
        words={"never": inf},
    )
    turn_after: float = setting(
        inf,
        "Path length after which the person turns once",
        Range(0.0, 100.0, "m", "the longest walk", also=(inf,)),
        words={"never": inf},
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
