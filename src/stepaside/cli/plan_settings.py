"""Settings of one maneuver."""

from dataclasses import dataclass, fields, replace
from math import pi

from ..core.errors import PlanError
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..games.duel_settings import GAIT_HELP, DuelSettings
from ..games.walk_settings import WalkSettings
from ..planning import PRESETS, Direction, Foot, GaitSettings

ROLES = {"pursuer": Direction.FORWARD, "evader": Direction.BACKWARD}
FEET = {foot.name.lower(): foot for foot in Foot}


@dataclass(frozen=True, slots=True)
class PlanSettings:
    """Settings of one maneuver."""

    role: str | None = setting(
        None,
        "Role: the pursuer walks forward, the evader backward",
        names=ROLES,
        option="--role",
    )
    bearing: float | None = setting(
        None,
        "Desired heading in the frame of the support foot {unit}; 0 is "
        "straight ahead",
        Range(-pi, pi, "rad", "half a turn", also=(None,)),
        option="--bearing",
    )
    steps: int = setting(
        20,
        "Number of footsteps",
        Range(1, 200, "steps", "more cannot be drawn", whole=True),
        option="--steps",
    )
    first_foot: str = setting(
        "left", "Foot that lands first", names=FEET, option="--first-foot"
    )
    saturated: bool = setting(
        False,
        "Turn by eq. (6) instead of eq. (8)",
        option="--saturated/--no-saturated",
    )
    gait: GaitSettings = setting(
        GaitSettings(),
        "Gait",
        presets=PRESETS,
        option="--gait",
        aliases=("--preset",),
        option_help=GAIT_HELP,
    )

    def __post_init__(self) -> None:
        """Check all values."""
        check_settings(self, PlanError)

    @property
    def preset(self) -> str | None:
        """Gait preset up to the ZMP profile; None for any other gait."""
        for name, gait in PRESETS.items():
            profile = self.gait.zmp_profile
            if replace(gait, zmp_profile=profile) == self.gait:
                return name
        return None


# Entries of walks and duels, which the file of a plan may contain.
ENTRIES_OF_GAMES = frozenset(
    field.name
    for kind in (DuelSettings, WalkSettings)
    for field in fields(kind)
)
