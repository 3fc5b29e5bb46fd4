"""Evasion: walk backward across the line of sight (paper, Sec. II-B)."""

from dataclasses import dataclass
from math import inf, pi, radians
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple, get_args

from ..core.errors import ConfigurationError
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..planning import Direction
from ..theory import laws
from .knowledge import STAND, Intent, Knowledge

if TYPE_CHECKING:
    from .approach import Approach

Trigger = Literal["distance", "time"]
SAFETY = Range(
    1e-3, 1e9, "m", "below a millimetre there is contact; 1e9 m means always"
)
RELEASE = Range(1e-3, 1e9, "m", "and above safety_radius", also=(inf,))
RELEASE_RATIO = 1.25  # release clearance over trigger clearance


class EvasionMemory(NamedTuple):
    """Memory of an evader."""

    evading: bool = False  # whether it evades
    side: int = 0  # +1 or -1; 0 while it does not evade
    safe: int = 0  # number of consecutive decisions in which standing was safe


def check_release(begins: float, ends: float) -> None:
    """Check that evasion ends at a larger distance than it begins, in [m]."""
    if not ends > begins:
        raise ConfigurationError(
            f"release_distance must exceed safety_radius, {begins:g} [m], or "
            f"evasion stops and starts, got {ends}"
        )


@dataclass(frozen=True, slots=True)
class Evasion:
    """The paper's evader: walk backward at an angle to the line of sight.

    The side is chosen when evasion begins, and changes only when the bearing
    of the pursuer is clearly on the other side.

    With the trigger time it begins when a pursuer with constant velocity
    would be near soon. It then walks across the path of the pursuer, turns as
    fast as its gait can, and keeps the side with the larger clearance until
    standing is safe.
    """

    direction: ClassVar = Direction.BACKWARD
    angle: float = setting(
        pi / 2,
        "Evasion angle alpha between the line of sight and the direction of "
        "walking {unit}: a right angle moves aside, 0 moves back",
        Range(0.0, pi, "rad", "the sign is given by the side"),
    )
    saturated: bool = setting(
        False,
        "Turn the evader by eq. (6) instead of eq. (4)",
    )
    safety_radius: float = setting(
        0.8,
        "Distance at which evasion begins {unit}, with the trigger distance",
        SAFETY,
        needs=("evasion.trigger", "distance"),
    )
    release_distance: float = setting(
        inf,
        "Distance at which evasion ends",
        RELEASE,
        needs=("evasion.trigger", "distance"),
    )
    side_hysteresis: float = setting(
        radians(20.0),
        "Angle by which the pursuer's bearing must exceed a change of sign "
        "before the evader changes side {unit}; from a right angle on it "
        "never does",
        Range(0.0, pi, "rad", "half a turn"),
        needs=("evasion.trigger", "distance"),
    )
    trigger: Trigger | None = setting(
        None,
        "Condition that triggers evasion: distance, or predicted time to "
        "contact",
        names=get_args(Trigger),
        default_text="time against a person with steps shorter than 0.4 s, "
        "else distance",
    )
    contact_time: float = setting(
        3.5,
        "Predicted time to contact at which evasion begins {unit}, with the "
        "trigger time; 1.5 times as much ends it",
        Range(0.1, 60.0, "s", "a step takes longer than 0.1 s"),
        needs=("evasion.trigger", "time"),
    )
    clearance: float = setting(
        0.7,
        "Distance that counts as contact {unit}, with the trigger time",
        Range(0.1, 10.0, "m", "the bodies have a width"),
        needs=("evasion.trigger", "time"),
    )

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)
        check_release(self.safety_radius, self.release_distance)

    @property
    def area(self) -> float:
        """Radius of the area that it keeps free around itself, in [m]."""
        return self.clearance if self.trigger == "time" else self.safety_radius

    def begin(self) -> EvasionMemory:
        """Return the memory of an evader that does not evade yet."""
        return EvasionMemory()

    def decide(
        self, knowledge: Knowledge, memory: EvasionMemory
    ) -> tuple[Intent, EvasionMemory]:
        """Stand until the trigger, then walk at the angle of (5)."""
        if self.trigger == "time":
            return self._decide_in_time(knowledge, memory)
        if not laws.is_evading(
            memory.evading,
            knowledge.distance,
            self.safety_radius,
            self.release_distance,
        ):
            return STAND, EvasionMemory()
        bearing = knowledge.bearing
        side = laws.update_side(memory.side, bearing, self.side_hysteresis)
        heading = laws.evasion_heading(bearing, side, self.angle)
        return Intent(heading), EvasionMemory(True, side)

    def _decide_in_time(
        self, knowledge: Knowledge, memory: EvasionMemory
    ) -> tuple[Intent, EvasionMemory]:
        """Decide with the trigger time."""
        from .approach import Approach

        approach = Approach.of(knowledge)
        safe = 0
        if not memory.evading:
            if approach.contact_time(self.clearance) >= self.contact_time:
                return STAND, EvasionMemory()
        else:
            soon = approach.contact_time(RELEASE_RATIO * self.clearance)
            safe = memory.safe + 1 if soon > 1.5 * self.contact_time else 0
            if safe > 1:  # sway alone can make a single decision safe
                return STAND, EvasionMemory()
        side = memory.side or self._clearer_side(knowledge, approach)
        error = laws.evasion_heading(approach.origin, side, self.angle)
        heading = knowledge.limits.correcting_heading(error)
        return Intent(heading), EvasionMemory(True, side, safe)

    def _clearer_side(self, knowledge: Knowledge, approach: "Approach") -> int:
        """Return the side with the larger predicted clearance."""
        left, right = (
            approach.predicted_clearance(
                knowledge.limits,
                laws.evasion_heading(approach.origin, side, self.angle),
                stands=not knowledge.moving,
            )
            for side in (1, -1)
        )
        if abs(left - right) < 1e-9:
            return laws.side_behind(approach.origin)
        return 1 if left > right else -1
