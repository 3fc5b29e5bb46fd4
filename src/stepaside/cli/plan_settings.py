"""Settings of one maneuver."""

from collections.abc import Collection
from dataclasses import dataclass, field, fields, replace
from math import pi
from typing import ClassVar

from ..core.errors import PlanError
from ..core.ranges import Range, Ranges, check_settings
from ..planning import PRESETS, Direction, Foot, GaitSettings

ROLES = {"pursuer": Direction.FORWARD, "evader": Direction.BACKWARD}
FEET = {foot.name.lower(): foot for foot in Foot}


@dataclass(frozen=True, slots=True)
class PlanSettings:
    """Settings of one maneuver.

    Attributes:
        role: "pursuer" walks forward, "evader" backward.
        bearing: Desired heading in the frame of the support foot, in [rad];
            -3.14159 to 3.14159 or none.
        steps: Number of footsteps; 1 to 200.
        first_foot: Foot that lands first: "left" or "right".
        saturated: Whether the robot turns by eq. (6) instead of eq. (8).
        gait: Gait of the robot.
    """

    role: str | None = None
    bearing: float | None = None
    steps: int = 20
    first_foot: str = "left"
    saturated: bool = False
    gait: GaitSettings = field(default_factory=GaitSettings)

    ranges: ClassVar[Ranges] = {
        "bearing": Range(-pi, pi, "rad", "half a turn", also=(None,)),
        "steps": Range(1, 200, "steps", "more cannot be drawn", whole=True),
    }

    def __post_init__(self) -> None:
        """Check all values."""
        check_settings(self, PlanError)
        for name, value, known in (
            ("role", self.role, ROLES),
            ("first_foot", self.first_foot, FEET),
        ):
            if value is not None and value not in known:
                raise PlanError(
                    f"{name} must be one of {', '.join(known)}, got {value!r}"
                )

    @property
    def preset(self) -> str | None:
        """Gait preset up to the ZMP profile; None for any other gait."""
        for name, gait in PRESETS.items():
            profile = self.gait.zmp_profile
            if replace(gait, zmp_profile=profile) == self.gait:
                return name
        return None


def entries_of_others() -> Collection[str]:
    """Return the configuration entries of walks and duels."""
    from ..games.duel_settings import DuelSettings
    from ..games.walk_settings import WalkSettings

    return {
        f.name for kind in (DuelSettings, WalkSettings) for f in fields(kind)
    }
